#!/usr/bin/env bash
# The browser test on two small runs that it simulates itself:  check.sh JAMSCOPE CHROMIUM
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
chromium=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for seed in 1 2; do
  "$program" simulate "$here/hopper.toml" -o "$folder/$seed" --bed-cache "" --set "bed.seed=$seed" -q
done
"$program" report "$folder/1" "$folder/2" -o "$folder/both.html" -q
cd "$here/../.."
npm run --silent test:browser -- "$folder/1/report.html" --run "$folder/1/run.h5" --program "$program" --several "$folder/both.html" --chromium "$chromium"
