#!/usr/bin/env bash
# Builds with AddressSanitizer and UBSan and runs the tests. Arguments go to ctest, e.g. -LE slow.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake --preset asan
cmake --build --preset asan
ctest --preset asan "$@"
