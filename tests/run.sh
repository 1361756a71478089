#!/usr/bin/env bash
# Everything that must hold before a change is merged:   tests/run.sh
# The long comparisons with theory and other codes:      tests/run.sh --validation
set -euo pipefail
cd "$(dirname "$0")/.."

mode=${1:-}
if [[ $# -gt 1 || ($mode != "" && $mode != --validation) ]]; then
  echo "usage: tests/run.sh [--validation]" >&2
  exit 2
fi
jobs=$(nproc)
at_once=$jobs
# Tests that run side by side with several threads each would spin for each other's processors.
export OMP_WAIT_POLICY=passive
folder=build-check

# check NAME TEST-SELECTION CMAKE-OPTION...: configure, build, test
check() {
  local name=$1 selection=$2
  shift 2
  echo "== $name"
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "${launcher[@]}" "$@" >/dev/null
  cmake --build "$folder" -j "$jobs"
  ctest --test-dir "$folder" -j "$at_once" --output-on-failure --no-tests=error "$selection" validation
}

.ci/setup.sh
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

if [[ $mode == --validation ]]; then
  at_once=1  # each uses all processors
  check "validation" -L -DJAMSCOPE_BUILD_DEM=ON -DJAMSCOPE_BUILD_JAM=ON
  exit 0
fi
.ci/check_arrows.sh
# Each library builds and passes its tests without the other. All three share one folder, so that nothing is compiled twice.
check "libdem without libjam" -LE -DJAMSCOPE_BUILD_DEM=ON -DJAMSCOPE_BUILD_JAM=OFF
check "libjam without libdem" -LE -DJAMSCOPE_BUILD_DEM=OFF -DJAMSCOPE_BUILD_JAM=ON
check "all" -LE -DJAMSCOPE_BUILD_DEM=ON -DJAMSCOPE_BUILD_JAM=ON

# The page of the report: its own tests, and whether the checked-in bundle is what its sources build.
echo "== report page"
if command -v npm >/dev/null && node -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)'; then
  (cd apps/report && npm ci --no-audit --no-fund && npm test && npm run check-bundle)
  # The page in a browser, where there is Debian's Chromium.
  if chromium=$(command -v chromium); then
    apps/report/tests/browser/check.sh "$folder/jamscope" "$chromium"
  else
    echo "browser test left out: chromium is not installed"
  fi
else
  echo "left out: npm with Node 20.19 or newer is not installed"
fi
echo "all checks passed"
