#!/usr/bin/env bash
# test_swift.sh SLUICE_BAKE MAKE_PICTURE FACTS: a store in an object store that checks signatures: OpenStack Swift with
# s3api, in a network namespace of its own. Needs its packages and root; skipped elsewhere. Prints TAP.
skip() {
    echo "1..0 # SKIP $*"
    exit 0
}
if [ -z "${SLUICE_SWIFT_INSIDE:-}" ]; then
    for program in swift-proxy-server swift-account-server swift-container-server swift-object-server swift-ring-builder; do
        command -v $program >/dev/null || skip "there is no $program (packages swift-proxy, -account, -container, -object)"
    done
    for program in python3 unshare ip; do command -v $program >/dev/null || skip "there is no $program"; done
    [ "$(id -u)" = 0 ] || skip "Swift needs root"
    [ -r /etc/swift/swift.conf ] || skip "there is no /etc/swift/swift.conf"
    unshare --net true 2>/dev/null || skip "network namespaces are not allowed here"
    SLUICE_SWIFT_INSIDE=yes exec unshare --net "$0" "$@"
fi
bake=$(realpath "$1") make_picture=$(realpath "$2") facts=$(realpath "$3")
# shellcheck source=/dev/null
. "$facts"
# shellcheck disable=SC2034 # it is what run runs
tool=$bake
ip link set lo up
user=$(id -un)

# One replica of each, without a cache of tokens in memcached.
ports=(6202 6201 6200)
servers=(account container object)
for i in 0 1 2; do
    name=${servers[$i]}
    mkdir -p "disks/$name/d1"
    cat >"$name.conf" <<END
[DEFAULT]
bind_ip = 127.0.0.1
bind_port = ${ports[$i]}
user = $user
swift_dir = $PWD
devices = $PWD/disks/$name
mount_check = false
workers = 0
[pipeline:main]
pipeline = $name-server
[app:$name-server]
use = egg:swift#$name
END
    ring=$name.builder
    { swift-ring-builder "$ring" create 4 1 1 && swift-ring-builder "$ring" add "r1z1-127.0.0.1:${ports[$i]}/d1" 1 &&
        swift-ring-builder "$ring" rebalance; } >rings 2>&1
done
cat >proxy.conf <<END
[DEFAULT]
bind_ip = 127.0.0.1
bind_port = 8080
user = $user
swift_dir = $PWD
workers = 0
[pipeline:main]
pipeline = cache s3api tempauth proxy-server
[app:proxy-server]
use = egg:swift#proxy
account_autocreate = true
[filter:cache]
use = egg:swift#memcache
[filter:s3api]
use = egg:swift#s3api
[filter:tempauth]
use = egg:swift#tempauth
user_test_tester = testing .admin
END
started=()
stop() {
    kill "${started[@]}" 2>/dev/null
    wait 2>/dev/null
    rm -rf "${folder:?}"
}
trap stop EXIT
start() { # NAME PORT: and waits until it listens
    local try
    "swift-$1-server" "$PWD/$1.conf" >"$1.log" 2>&1 &
    started+=($!)
    for ((try = 0; try < 600; try++)); do
        (exec 3<>"/dev/tcp/127.0.0.1/$2") 2>/dev/null && return
        sleep 0.1
    done
}
# The proxy leaves servers that it cannot reach alone for a minute.
for i in 0 1 2; do start "${servers[$i]}" "${ports[$i]}"; done
start proxy 8080
# Signs as Amazon's documents say; curl's own option takes no colon in the key, which Swift's keys have.
cat >put.py <<'END'
import datetime, hashlib, hmac, http.client, sys
path, body = sys.argv[1], open(sys.argv[2], "rb").read() if len(sys.argv) > 2 else b""
stamp = datetime.datetime.utcnow().strftime("%Y%m%dT%H%M%SZ")
scope = stamp[:8] + "/us-east-1/s3/aws4_request"
headers = {"host": "127.0.0.1:8080", "x-amz-content-sha256": "UNSIGNED-PAYLOAD", "x-amz-date": stamp}
asked = "\n".join(["PUT", path, ""] + [f"{name}:{value}" for name, value in headers.items()] +
                  ["", ";".join(headers), "UNSIGNED-PAYLOAD"])
text = "\n".join(["AWS4-HMAC-SHA256", stamp, scope, hashlib.sha256(asked.encode()).hexdigest()])
key = b"AWS4testing"
for word in scope.split("/"):
    key = hmac.new(key, word.encode(), hashlib.sha256).digest()
headers["Authorization"] = (f"AWS4-HMAC-SHA256 Credential=test:tester/{scope}, SignedHeaders={';'.join(headers)}, "
                            f"Signature={hmac.new(key, text.encode(), hashlib.sha256).hexdigest()}")
connection = http.client.HTTPConnection("127.0.0.1", 8080, timeout=60)
connection.request("PUT", path, body, headers)
answer = connection.getresponse()
sys.exit(0 if answer.status == 200 else f"{answer.status}: {answer.read()[:500]}")
END
put() { python3 put.py "$@" 2>>err; }
"$make_picture" rgb 300 200 1 p.png && "$bake" p.png -o p.store >out 2>err && put /tiles && put /tiles/a%20b/p.store p.store
fact swift_runs_and_takes_a_store

export AWS_ENDPOINT_URL=http://127.0.0.1:8080 AWS_REGION=us-east-1 AWS_ACCESS_KEY_ID=test:tester
export AWS_SECRET_ACCESS_KEY=testing
run 0 --verify 's3://tiles/a b/p.store' && grep -q '^whole .*s3://tiles/a b/p.store' out
fact signatures_are_those_that_swift_computes_also_for_names_with_blanks
(AWS_SECRET_ACCESS_KEY=wrong && run 1 --verify 's3://tiles/a b/p.store') && grep -q 'answers 403' err && ! grep -q wrong err
fact a_wrong_secret_is_refused_and_not_shown
(unset AWS_ACCESS_KEY_ID && run 1 --verify 's3://tiles/a b/p.store') && grep -q 'answers 400' err
fact requests_without_a_signature_are_refused
run 1 --verify s3://tiles/none.store && grep -q 'answers 404' err
fact an_object_that_is_not_there_is_named
head -c 20000 p.store >short.store && put /tiles/cut.store short.store && run 1 --verify s3://tiles/cut.store
fact a_store_that_was_cut_is_found_out
end_facts
