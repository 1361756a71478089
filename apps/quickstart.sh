#!/usr/bin/env bash
# From a fresh clone to the first report:   apps/quickstart.sh [OUTPUT FOLDER]
set -euo pipefail
out=$(realpath -m "${1:-out}")
cd "$(dirname "$0")/.."

.ci/setup.sh
cmake --preset release
cmake --build --preset release --target jamscope
build/jamscope simulate data/cases/ft4_quick.toml -o "$out"
echo
echo "The report is $out/report.html; open it in a browser."
