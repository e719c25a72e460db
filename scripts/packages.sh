#!/usr/bin/env bash
# Install the Debian packages that are missing: scripts/packages.sh [run|test]
# run: what `sabot` is built from; test (standard): also what charts, tests,
# benchmarks and checks of the code need.
set -euo pipefail

packages=(g++ cmake ninja-build libdeal.ii-dev libvtk9-dev libeigen3-dev
  libcli11-dev libssl-dev nlohmann-json3-dev openmpi-bin python3)
case ${1:-test} in
run) ;;
test)
  packages+=(ccache clang-format git hdf5-tools libbenchmark-dev libgtest-dev
    universal-ctags valgrind xauth xvfb)
  ;;
*)
  echo "usage: scripts/packages.sh [run|test]" >&2
  exit 1
  ;;
esac

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
