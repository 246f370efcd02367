#!/usr/bin/env bash
# clang-tidy over the sources of build/release (src, tools, tests, cuda) by the checks of .clang-tidy. Arguments limit it:
#   tools/lint.sh src/sim            paths that have this in them
#   tools/lint.sh --since COMMIT     what differs from there: sources, and those beside changed headers
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
if [[ -z $tidy ]]; then
  echo "tools/lint.sh: clang-tidy is missing; apt-get install clang-tidy" >&2
  exit 1
fi
cmake --preset release > /dev/null

# Sources of the compile commands only: kernels (.cu) it does not parse.
root=$(pwd -P)
pattern="^$root/(src|tools|tests|cuda)/.*\.cpp$"
mapfile -t files < <(
  sed -n 's/^ *"file": "\(.*\)".*$/\1/p' build/release/compile_commands.json | sort -u |
    grep -E "$pattern" || true
)
if [[ ${1:-} == --since ]]; then
  changed=$(git diff --name-only --diff-filter=d "${2:?tools/lint.sh: --since needs a commit}" -- '*.cpp' '*.h')
  mapfile -t files < <(
    printf '%s\n' "${files[@]}" | grep -xF "$(sed "s#^#$root/#; s#\.h\$#.cpp#" <<< "$changed")" || true)
  if [[ ${#files[@]} -eq 0 ]]; then
    echo "lint: no source differs from $2"
    exit 0
  fi
elif [[ $# -gt 0 ]]; then
  mapfile -t files < <(printf '%s\n' "${files[@]}" | grep -F "$(printf '%s\n' "$@")" || true)
fi
if [[ ${#files[@]} -eq 0 ]]; then
  echo "tools/lint.sh: no source matches" >&2
  exit 1
fi
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P 2 "$tidy" --quiet -p build/release
echo "lint: ${#files[@]} files"
