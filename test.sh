#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds, runs every check and every test. Stops at the first step that fails.
#   ./test.sh           all checks and tests; the longest tests take turns (scripts/turn), as do the sanitizers' programs
#   ./test.sh --all     the same with every test
#   ./test.sh --quick   release build and unit tests only
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"

case "${1:-}" in
  "" | --all)
    steps=(packages format module_order machine_paths documents sizes build tests commands instrumented_build sanitizers
           threads lint) ;;
  --quick) steps=(packages build unit_tests) ;;
  *) echo "usage: ./test.sh [--all | --quick]" >&2; exit 2 ;;
esac
all=
if [ "${1:-}" = --all ]; then all=yes; fi
export STYLET_CACHE=$PWD/build/kept  # meshes that many tests need

# run_tests PRESET [CTEST OPTION…]: runs tests side by side and prints how long they took, label by label.
run_tests() {
  local times=$PWD/build/test_times/$1.xml
  local options=("${@:2}")
  if [ -z "$all" ]; then
    scripts/turn check "$1" || return
    options+=(--exclude-regex "$(scripts/turn exclude "$1")")
  fi
  if [ "$(ctest --preset "$1" "${options[@]}" --show-only | grep -c "Test *#")" -eq 0 ]; then
    echo "none of these tests runs in this turn"
    return
  fi
  mkdir -p build/test_times
  ctest --preset "$1" "${options[@]}" --output-junit "$times" || return
  scripts/test_times "$1" "$times"
}

packages()      { scripts/install_packages; }
format()        { scripts/check_format; }
module_order()  { scripts/check_module_order; }
machine_paths() { scripts/check_machine_paths; }
documents()     { scripts/check_documents; }
sizes()         { mkdir -p build; scripts/class_sizes --check > build/class_sizes.txt || { cat build/class_sizes.txt; return 1; }; scripts/lines; }
build()         { scripts/build release; }
commands()      { scripts/check_commands build/bin/stylet; }
unit_tests()    { run_tests release --parallel "$(nproc)" --label-regex unit; }
sanitizers()    { run_tests sanitize --parallel "$(nproc)" --label-regex 'unit|long'; }
threads()       { run_tests threads; }
lint()          { scripts/check_lint; }

# instrument PRESET LABELS: compiles the programs of a preset with sanitizers that run in this turn.
instrument() {
  nice -n 15 cmake --preset "$1" --log-level=NOTICE || return
  local programs=
  if [ -z "$all" ]; then
    programs=$(scripts/turn targets "$1" "$2") || return
    if [ -z "$programs" ]; then return 0; fi
  fi
  # shellcheck disable=SC2086 # names of targets, one word each
  nice -n 15 scripts/build "$1" $programs
}
# The tests leave a processor idle now and then: the instrumented programs are compiled there meanwhile.
compiling=
tests() {
  { instrument sanitize 'unit|long' && instrument threads threads; } > build/instrumented_build.log 2>&1 &
  compiling=$!
  run_tests release --parallel "$(nproc)"
}
instrumented_build() {
  local status=0
  wait "$compiling" || status=$?
  compiling=
  if [ $status -ne 0 ]; then tail -n 60 build/instrumented_build.log >&2; fi
  return $status
}

declare -A about=(
  [packages]="installing what is missing"
  [format]="code is formatted as .clang-format says"
  [module_order]="modules include only what lies left of them"
  [machine_paths]="no path of one machine in the sources"
  [documents]="lines of documents, links, names of tests, and phrases that lack their noun"
  [sizes]="members and lines of every class; lines by module"
  [build]="release build into build/"
  [unit_tests]="unit tests"
  [tests]="tests: unit, long, command line, browser, real data, slow, installed library"
  [commands]="every command that a document shows"
  [instrumented_build]="the rest of the builds with sanitizers, begun beside the tests"
  [sanitizers]="core to realtime under address and undefined-behaviour sanitizers, unit and long tests"
  [threads]="what runs in several threads under the thread sanitizer"
  [lint]="clang-tidy on core to realtime, igtl and stylet_rt"
)

# Puts the processor time (user and system) of all commands that have ended so far into processor_s [s]. The shell itself
# has to ask: its children's time is not known in a subshell.
measure() {
  times > "$clock"
  processor_s=$(awk -F '[ms ]+' 'NR == 2 { print int($1 * 60 + $2 + $3 * 60 + $4) }' "$clock")
}
# How many objects the compiler cache has handed out, and how many it could not: "hits misses".
cache_counts() {
  command -v ccache > /dev/null && ccache --print-stats |
    awk '/^(direct|preprocessed)_cache_hit/ { hits += $2 } /^cache_miss/ { misses += $2 } END { print hits + 0, misses + 0 }'
}

finish() {
  local status=$?
  rm -f "$clock"
  if [ -n "$compiling" ]; then kill "$compiling" 2> /dev/null || true; fi
  [ $status -eq 0 ] || echo "test.sh: FAILED in step \"$step\" (${about[$step]:-})" >&2
}

rows=()
step=
clock=$(mktemp)
trap finish EXIT
read -r hits misses < <(cache_counts || echo 0 0)
for step in "${steps[@]}"; do
  number=$((${#rows[@]} + 1))
  echo "[$number/${#steps[@]}] $step: ${about[$step]}"
  started=$SECONDS
  measure
  busy=$processor_s
  "$step"
  measure
  rows+=("$(printf '%6d s %12d s  %s' $((SECONDS - started)) $((processor_s - busy)) "$step")")
done
echo "test.sh: all passed in $SECONDS s, with $processor_s s of processor time"
echo "    wall    processor  step"
printf '%s\n' "${rows[@]}"
read -r hits_now misses_now < <(cache_counts || echo 0 0)
asked=$((hits_now - hits + misses_now - misses))
if [ "$asked" -gt 0 ]; then
  echo "compiler cache: $((100 * (hits_now - hits) / asked)) % of $asked objects were there already"
fi
