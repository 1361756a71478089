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

# configure and build a preset, then run its tests
check() {
  local preset=$1 folder=$2
  shift 2
  echo "== $preset"
  cmake --preset "$preset" "${launcher[@]}" >/dev/null
  cmake --build --preset "$preset" -j "$jobs"
  ctest --test-dir "$folder" -j "$jobs" --output-on-failure --no-tests=error "$@"
}

.ci/setup.sh
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

if [[ $mode == --validation ]]; then
  check release build -L validation
  exit 0
fi
.ci/check_arrows.sh
check release build -LE validation
# Each library builds and passes its tests without the other. What they share with the build above is only compiled here to
# see that it compiles, so optimisation would be wasted time.
alone=(-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1)
launcher+=("${alone[@]}")
check dem-only build-dem -LE validation
check jam-only build-jam -LE validation
echo "all checks passed"
