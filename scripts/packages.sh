#!/usr/bin/env bash
# Install the Debian packages that Sabot is built from, if any is missing.
set -euo pipefail

packages=(g++ cmake ninja-build git libdeal.ii-dev libvtk9-dev libeigen3-dev
  libcli11-dev libssl-dev nlohmann-json3-dev libgtest-dev libbenchmark-dev openmpi-bin
  hdf5-tools ccache python3 xvfb xauth)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null |
    grep -q 'install ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

echo "Installing: ${missing[*]}"
sudo=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "error: run as root or install sudo; missing: ${missing[*]}" >&2
    exit 1
  }
  sudo=(sudo)
fi
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
