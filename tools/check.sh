#!/usr/bin/env bash
# What must pass before a push: format, build, tests without the slow ones, lint.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/format.sh --check
cmake --preset release
cmake --build --preset release
ctest --preset release -LE slow
tools/lint.sh
