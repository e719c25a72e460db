#!/usr/bin/env bash
# Configure and build: scripts/build.sh [release|debug|asan-ubsan]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
# ccache without a second run of the preprocessor
export CCACHE_DEPEND=${CCACHE_DEPEND:-1}
options=()
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake --preset "$preset" "${options[@]}" >"/dev/null"
cmake --build --preset "$preset"
