#!/usr/bin/env bash
# Runs the case of data/reference/networks/pea.h5 (a few seconds), exports its frames and lets another program look at them.
#
#   tests/tools/check.sh paraview JAMSCOPE PVPYTHON
#   tests/tools/check.sh networkx JAMSCOPE PYTHON
set -euo pipefail
what=$1 jamscope=$2 python=$3
tools=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$jamscope" export "$tools/../../data/reference/networks/pea.h5" --to csv -q -o "$folder/pea"  # with case.toml
"$jamscope" simulate "$folder/pea/case.toml" -o "$folder/run" --bed-cache "" --threads 1 -q
run=$folder/run/run.h5
case $what in
  paraview)
    "$jamscope" inspect "$run" --json >"$folder/inspect.json"
    "$jamscope" export "$run" --to vtp -q -o "$folder/vtp"
    "$python" --force-offscreen-rendering "$tools/check_in_paraview.py" "$folder/inspect.json" "$folder/run/run.xdmf" "$folder/vtp"
    ;;
  networkx)
    "$jamscope" export "$run" --to graphml -q -o "$folder/graphml"
    "$jamscope" export "$run" --to csv -q -o "$folder/csv"
    "$python" "$tools/check_in_networkx.py" "$folder/graphml" "$folder/csv"
    ;;
esac
