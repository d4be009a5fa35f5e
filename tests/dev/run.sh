#!/usr/bin/env bash
# What ./dev asks apt for on a machine with nothing installed, and what it builds: a copy of it runs with stand-ins for
# the programs that it calls, each of which only writes down its arguments.
set -euo pipefail
source=$(dirname "$(readlink -f "$0")")/../..
scratch=$(mktemp -d -t depthgrid-dev.XXXXXX)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch"/bin "$scratch"/tree/{mapper,sim,eval,tests,bench,docs}
cp -r "$source/dev" "$source/.ci" "$scratch/tree"
touch "$scratch/tree/mapper/a.cc"
export DEV_CALLS=$scratch/calls
for program in apt-get cmake ctest clang-format cppcheck; do
  printf '#!/bin/sh\necho "%s $*" >>"$DEV_CALLS"\n' $program >"$scratch/bin/$program"
done
printf '#!/bin/sh\nexit 1\n' >"$scratch/bin/dpkg-query"
printf '#!/bin/sh\nexec "$@"\n' >"$scratch/bin/sudo"
chmod +x "$scratch"/bin/*
export PATH=$scratch/bin:$PATH

failed=0
# calls COMMAND: what ./dev COMMAND calls.
calls() {
  : >"$DEV_CALLS"
  "$scratch/tree/dev" "$@" >"$scratch/out" 2>&1 || { cat "$scratch/out"; failed=1; }
}
# expect yes|no PATTERN: whether a call matches it.
expect() {
  local found=no
  ! grep -Eq -- "$2" "$DEV_CALLS" || found=yes
  [ $found = "$1" ] || { echo "expected $1: '$2' in"; cat "$DEV_CALLS"; failed=1; }
}

calls lint
expect yes '^apt-get install .*--no-install-recommends clang-format cppcheck$'
calls build
expect yes '^apt-get install .* libceres-dev '
expect no '^apt-get install .*(chromium|clang|slurm)'
# Known: one that is there, one that was, and half of one.
printf '#!/bin/sh\nprintf "%%s\\n" "ninja-build install ok installed" "libceres-dev deinstall ok config-files" ' \
  >"$scratch/bin/dpkg-query"
printf '"cmake install ok half-installed" "build-essential hold ok installed"\nexit 1\n' >>"$scratch/bin/dpkg-query"
calls build
expect yes '^apt-get install .* libceres-dev '
expect yes '^apt-get install .* cmake '
expect no '^apt-get install .*(ninja-build|build-essential)'
printf '#!/bin/sh\nexit 1\n' >"$scratch/bin/dpkg-query"
calls test
expect yes '^apt-get install .* libceres-dev .* chromium .* python3-numpy python3-zstandard$'
expect yes '^cmake --preset release .*-DDEPTHGRID_WERROR=ON$'
calls test --with-slurm
expect yes '^apt-get install .* libceres-dev .* chromium .* slurm-wlm$'
calls sanitize
expect yes '^apt-get install .* libceres-dev .* chromium .* clang '
expect no '-DDEPTHGRID_WERROR=ON'
calls install "$scratch/prefix"
expect no '^apt-get install .*chromium'
expect yes '^cmake --build build/release .*--target installed$'
expect yes "^cmake --install build/release --prefix $scratch/prefix$"
exit $failed
