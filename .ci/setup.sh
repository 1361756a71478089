#!/usr/bin/env bash
# Installs the Debian/Ubuntu packages that jamscope is built from, and only those that are missing.
set -euo pipefail

packages=(
  g++ cmake ninja-build git ca-certificates pkg-config
  libeigen3-dev libboost-graph-dev libboost-iostreams-dev libhdf5-dev libdeflate-dev libcgal-dev libspectra-dev libmetis-dev libgmp-dev libmpfr-dev
  libgtest-dev libgmock-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libspdlog-dev libssl-dev libudunits2-dev
  python3-dev python3-numpy python3-h5py pybind11-dev  # the Python module and its tests
)

if ! command -v dpkg-query >/dev/null; then
  echo "setup: this is no Debian or Ubuntu; install by hand: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

echo "setup: installing ${missing[*]}"
as_root=()
if ((EUID != 0)); then
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
