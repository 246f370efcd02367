#!/usr/bin/env bash
# Formats all C++ sources in place; with --check changes nothing and fails where something would change.
# Pinned to clang-format 14, as other versions break lines elsewhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

format=$(command -v clang-format-14 || command -v clang-format || true)
if [[ -z $format ]] || ! "$format" --version | grep -q 'version 14\.'; then
  echo "tools/format.sh: clang-format 14 is missing; apt-get install clang-format-14" >&2
  exit 1
fi

arguments=(-i)
case ${1:-} in
  '') ;;
  --check) arguments=(--dry-run --Werror) ;;
  *) echo "usage: tools/format.sh [--check]" >&2; exit 2 ;;
esac

find src tests tools cuda -type f \
  \( -name '*.h' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \) -print0 |
  xargs -0 -r "$format" "${arguments[@]}"
