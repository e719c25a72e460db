#!/usr/bin/env bash
# Configure and build:
#   scripts/build.sh [release|portable|debug|asan-ubsan] [-DOPTION=VALUE...]
# all programs and tests;
#   scripts/build.sh release sabot
# the program alone, which needs fewer packages;
#   scripts/build.sh release -DSABOT_PRECOMPILE=OFF
# each file with nothing but its own includes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
shift || true
options=() targets=()
for word in "$@"; do
  case $word in
  -D*) options+=("$word") ;;
  *) targets+=("$word") ;;
  esac
done
# ccache without a second run of the preprocessor, and with headers that are
# parsed once
export CCACHE_DEPEND=${CCACHE_DEPEND:-1}
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
if [ "${targets[*]}" != sabot ]; then
  options+=(-DSABOT_PROGRAM_ONLY=OFF)
elif [ ! -f "build/$preset/CMakeCache.txt" ]; then
  options+=(-DSABOT_PROGRAM_ONLY=ON)
fi
cmake --preset "$preset" "${options[@]}" >"/dev/null"
cmake --build --preset "$preset" ${targets[@]+--target "${targets[@]}"}
