# What the tests of programs share; to be sourced. Sets $work, a folder that goes at exit, and counts $failures.
set -u
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failures=0

expect() { # what, expected, found
    if [ "$2" != "$3" ]; then
        echo "$1: expected '$2', found '$3'"
        failures=$((failures + 1))
    fi
}

# Refusals: the exit code, one line on standard error and none on standard output.
refused() { # expected code, command...
    code=$1
    shift
    "$@" > "$work/out" 2> "$work/err"
    expect "exit of $*" "$code" $?
    expect "lines of $*" 1 "$(wc -l < "$work/err" | tr -d ' ')"
    expect "output of $*" 0 "$(wc -c < "$work/out" | tr -d ' ')"
}

finish() {
    [ "$failures" -eq 0 ] || echo "$failures checks failed"
    [ "$failures" -eq 0 ]
}
