# shellcheck shell=bash
# The stages of ./test: each runs on even when an earlier one failed, says how long it took, and counts what it tested.
# Sourced after setup.sh.

logs=${logs:?setup.sh comes first}
passed=0
failed=0
table=()

# stage NAME COMMAND...
# A log with doctest's totals or lines 'N passed, N failed' gives the counts; any other stage counts as one test.
stage() {
  local name=$1 log=$logs/test-$((${#table[@]} + 1)).log began=$EPOCHREALTIME good=0 bad=0 verdict=ok took
  shift
  printf '%-58s ' "$name"
  ("$@") >"$log" 2>&1 </dev/null || verdict=FAILED
  took=$(awk -v a="$began" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }')
  read -r good bad < <(count "$log")
  if [ "$verdict" = FAILED ]; then
    [ "$bad" -gt 0 ] || bad=1
  elif [ $((good + bad)) = 0 ]; then
    good=1
  fi
  [ "$bad" = 0 ] || verdict=FAILED
  passed=$((passed + good))
  failed=$((failed + bad))
  table+=("$(printf '%-58s %-6s %5d passed %4d failed %8s s' "$name" "$verdict" "$good" "$bad" "$took")")
  printf '%-6s %7s s\n' "$verdict" "$took"
  [ "$verdict" = ok ] || { tail -n 60 "$log"; say "All it said is in $log"; }
}

# count LOG: the sums of 'passed' and 'failed' over doctest's totals, vitest's, unittest's, and plain closing lines.
count() {
  # Without colours, and without the test's number that CTest puts before each line.
  sed -E 's/\x1b\[[0-9;]*m//g; s/^[0-9]+: //' "$1" | awk '
    /\[doctest\] test cases:/ { split($0, part, "|"); good += part[2]; bad += part[3] }
    /^ +Tests +[0-9]+ (passed|failed)/ { for (i = 2; i < NF; ++i) { if ($(i + 1) == "passed") good += $i; if ($(i + 1) == "failed") bad += $i } }
    /^[0-9]+ passed, [0-9]+ failed/ { good += $1; bad += $3 }
    /^Ran [0-9]+ tests? in / { good += $2 }
    /^FAILED \((failures|errors)=/ { n = split($0, part, "="); for (i = 2; i <= n; ++i) { bad += part[i]; good -= part[i] } }
    END { print good + 0, bad + 0 }'
}

finish() {
  say ""
  printf '%s\n' "${table[@]}"
  say ""
  say "All of this took $SECONDS s; logs are in $logs."
  say "$passed passed, $failed failed"
  [ "$failed" = 0 ] || exit 1
}

check_format() {
  find include src apps python tests studio/engine -name '*.h' -print0 -o -name '*.cpp' -print0 | xargs -0 clang-format-22 --dry-run --Werror
}

# build PRESET [OPTION...]: configures and builds everything.
build() {
  local preset=$1
  shift
  cmake --preset "$preset" "$@" && cmake --build "build/$preset" -- -k 0
}

# build_some PRESET TARGET...: configures, and builds these.
build_some() {
  cmake --preset "$1" && cmake --build "build/$1" --target "${@:2}"
}

# run_tests PRESET [OPTION...]: the CTest tests of a build (all, or as the options say), verbosely, so that doctest's totals can be counted.
run_tests() {
  ctest --test-dir "build/$1" --no-tests=error --verbose "${@:2}"
}
