# Facts about a tool, as TAP, in a folder that is removed at the end. Sourced by the tests beside it.
# shellcheck shell=bash
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
number=0 status=0

# fact NAME: the exit status before it says whether it is so
fact() {
    local result=$?
    number=$((number + 1))
    if [ $result -eq 0 ]; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        sed 's/^/# /' out err 2>/dev/null
        status=1
    fi
}

# run STATUS ARGUMENTS...: whether $tool ends with this status; its words are in out and err
run() {
    local expected=$1 got=0
    shift
    "${tool:?}" "$@" >out 2>err || got=$?
    [ $got -eq "$expected" ]
}

# The plan, and the exit status of the test.
end_facts() {
    echo "1..$number"
    exit "$status"
}
