#!/usr/bin/env bash
# Builds with AddressSanitizer and UBSan and runs the tests. Arguments go to ctest, e.g. -LE slow.
# --readers: only the tests of what reads files, which is where hostile bytes come in; not those of the parts in models/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

targets=()
if [[ ${1:-} == --readers ]]; then
  shift
  targets=(--target rangepose_io_test rangepose_database_test)
  set -- --label-regex '^(io|database)$' --exclude-regex '/Models/' "$@"
fi
cmake --preset asan
cmake --build --preset asan "${targets[@]}"
ctest --preset asan --parallel "$(nproc)" "$@"
