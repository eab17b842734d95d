#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds, runs every check and every test. Stops at the first step that fails.
#   ./test.sh           everything
#   ./test.sh --quick   release build and unit tests only
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"

case "${1:-}" in
  "") steps=(packages format module_order machine_paths build tests sanitizers threads lint) ;;
  --quick) steps=(packages build unit_tests) ;;
  *) echo "usage: ./test.sh [--quick]" >&2; exit 2 ;;
esac

packages()      { scripts/install_packages; }
format()        { scripts/check_format; }
module_order()  { scripts/check_module_order; }
machine_paths() { scripts/check_machine_paths; }
build()         { scripts/build release; }
unit_tests()    { ctest --preset release --parallel "$(nproc)" --label-regex unit; }
tests()         { ctest --preset release --parallel "$(nproc)"; }
sanitizers()    { scripts/build sanitize; ctest --preset sanitize --parallel "$(nproc)" --label-regex 'unit|long'; }
threads()       { scripts/build threads; ctest --preset threads; }
lint()          { scripts/check_lint; }

declare -A about=(
  [packages]="installing what is missing"
  [format]="code is formatted as .clang-format says"
  [module_order]="modules include only what lies left of them"
  [machine_paths]="no path of one machine in the sources"
  [build]="release build into build/"
  [unit_tests]="unit tests"
  [tests]="all tests: unit, long, command line, browser, real data, slow, installed library"
  [sanitizers]="core to realtime under address and undefined-behaviour sanitizers, unit and long tests"
  [threads]="what runs in several threads under the thread sanitizer"
  [lint]="clang-tidy on core to realtime and stylet_rt"
)

times=()
step=
trap 'status=$?; [ $status -eq 0 ] || echo "test.sh: FAILED in step \"$step\" (${about[$step]:-})" >&2' EXIT
for step in "${steps[@]}"; do
  number=$((${#times[@]} + 1))
  echo "[$number/${#steps[@]}] $step: ${about[$step]}"
  started=$SECONDS
  "$step"
  times+=("$(printf '%6d s  %s' $((SECONDS - started)) "$step")")
done
echo "test.sh: all passed in $SECONDS s"
printf '%s\n' "${times[@]}"
