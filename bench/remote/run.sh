#!/usr/bin/env bash
# Measures tiles from a web server over lines with a delay, and prints a table: ranges and tiles per
# second beside a loop around libcurl that reads the same ranges.
#
#   bench/remote/run.sh [options]
#   bench/remote/run.sh [--bin DIR] --serve MILLISECONDS FILE -- COMMAND...
#
# The second form serves a file over such a line while COMMAND runs: %u in it is the URL.
#
#   --round-trips LIST  milliseconds (default: 0,10,50,200); 0 is the loopback device
#   --requests LIST     requests in flight (default: 1,8,32,128)
#   --quick             10 ms, 4 requests, a small store, a moment each
#   --json              one object per line (name, value, unit) instead of the table
#   --bin DIR           build folder with the programs, instead of building
#   --work DIR          keep store, logs and build there (default: a scratch folder, removed)
#   --help
#
# The server is nginx with one process, on the other side of two network devices in network
# namespaces of their own. delay.c holds each packet for half of the round trip, so handshakes and
# slow start take as long as on a real line. The server sends with "cubic": with "bbr", the default
# of some systems, a tile takes 1.6 round trips. Nothing outside the namespaces is touched.
#
# Needs Linux, nginx, ip (iproute2), unshare (util-linux), awk, /dev/net/tun, and root or user
# namespaces; without --bin also meson, ninja, a C compiler and what the samples need.
#
# Exit status: 0; 1 if a measurement failed; 77 if something of that is missing.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C PATH=$PATH:/usr/sbin:/sbin

file=tiles.sluice round_trips=0,10,50,200 requests=1,8,32,128 edge=4096 json=no bin='' work='' scratch='' quick=()
given=("$@") served='' command=()
server=''

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}
skip() {
    say "skipped: $*"
    exit 77
}

while [ $# -gt 0 ]; do
    case $1 in
    --quick) quick=(--quick) round_trips=10 requests=4 edge=1024 ;;
    --json) json=yes ;;
    --serve)
        [ $# -ge 3 ] || die "--serve needs milliseconds and a file"
        round_trips=$2 served=$(realpath "$3")
        [ -r "$served" ] || die "$3 cannot be read"
        shift 2
        ;;
    --) shift; command=("$@"); break ;;
    --round-trips | --requests | --bin | --work)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        name=${1#--}
        declare "${name//-/_}=$2"
        shift
        ;;
    --help) sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) die "unknown option $1 (see --help)" ;;
    esac
    shift
done

# Everything runs in a network namespace of its own, with the rights of root in it.
enter_namespace() {
    local map=()
    [ "$(id -u)" = 0 ] || map=(--map-root-user)
    for program in nginx ip unshare awk; do
        command -v "$program" >/dev/null || skip "$program is not installed"
    done
    [ -w /dev/net/tun ] || skip "/dev/net/tun cannot be written"
    unshare --net "${map[@]}" true 2>/dev/null || skip "network namespaces are not allowed here"
    SLUICE_REMOTE_INSIDE=yes exec unshare --net "${map[@]}" "$0" "${given[@]}"
}
[ -n "${SLUICE_REMOTE_INSIDE:-}" ] || enter_namespace

stop_server() {
    [ -n "$server" ] || return 0
    kill "$(cat "$work/nginx/pid")" 2>/dev/null || true
    wait "$server" || true
    server=''
}
finish() {
    stop_server
    [ -z "$scratch" ] || rm -rf "$scratch"
}
trap finish EXIT
if [ -z "$work" ]; then
    scratch=$(mktemp -d)
    work=$scratch
fi
mkdir -p "$work/nginx" "$work/files"
work=$(cd "$work" && pwd)

if [ -z "$bin" ]; then
    say "building"
    bin=$work/build
    again=()
    [ ! -d "$bin" ] || again=(--reconfigure)
    { meson setup "${again[@]}" "$bin" "$root" --buildtype=release -Db_ndebug=if-release \
        -Ddefault_library=static -Dtests=false &&
        ninja -C "$bin" bench/remote/remote_figures bench/remote/delay; } >"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "the build failed"
    }
fi
bin=$(cd "$bin" && pwd)/bench/remote

write_configuration() {
    cat >"$work/nginx/nginx.conf" <<END
user $(id -un);
worker_processes 1;
daemon off;
pid $work/nginx/pid;
error_log $work/nginx/error.log warn;
events { worker_connections 1024; }
http {
    log_format lengths '\$request_length \$bytes_sent \$body_bytes_sent';
    access_log $work/nginx/access.log lengths;
    client_body_temp_path $work/nginx/body;
    proxy_temp_path $work/nginx/proxy;
    fastcgi_temp_path $work/nginx/fastcgi;
    uwsgi_temp_path $work/nginx/uwsgi;
    scgi_temp_path $work/nginx/scgi;
    sendfile on;
    tcp_nopush on;
    keepalive_requests 1000000;
    server {
        listen 8080 reuseport;
        root $work/files;
    }
}
END
}

# start_server MILLISECONDS: sets url
start_server() {
    local nginx=(nginx -p "$work/nginx" -c "$work/nginx/nginx.conf" -e "$work/nginx/error.log")
    local host=127.0.0.1
    [ "$1" = 0 ] || host=10.97.0.2
    printf -v url '%s://%s:8080/%s' http "$host" "$file"
    rm -f "$work/nginx/pid"
    if [ "$1" = 0 ]; then
        "${nginx[@]}" &
        server=$!
    else
        # shellcheck disable=SC2016 # the shell behind the line expands it
        "$bin/delay" "$1" sh -c 'ip address add 10.97.0.2 peer 10.97.0.1 dev far && ip link set far up &&
            { ip route change 10.97.0.1 dev far congctl cubic || echo "the server cannot use cubic" >&2; } &&
            exec "$@"' sh "${nginx[@]}" &
        server=$!
        wait_for ip link show near
        ip address add 10.97.0.1 peer 10.97.0.2 dev near
        ip link set near up
    fi
    wait_for test -s "$work/nginx/pid"
}

wait_for() {
    local left
    for ((left = 100; left > 0; left--)); do
        "$@" >/dev/null 2>&1 && return 0
        kill -0 "$server" 2>/dev/null || break
        sleep 0.05
    done
    cat "$work/nginx/error.log" >&2
    die "the server did not start"
}

figures() { # OPTION...
    "$bin/remote_figures" --json "${quick[@]}" "$@" \
        "$work/files/tiles.sluice" "$url" >>"$work/figures" || die "measuring failed"
}

measure_requests() { # of the tiles that were just read: all but the opening
    awk '{ n++; request += $1; header += $2 - $3 }
        END { printf "{\"name\": \"tile.request\", \"value\": %.6g, \"unit\": \"B\"}\n", request / n }' \
        "$work/nginx/access.log"
}

: >"$work/figures"
write_configuration
if [ -n "$served" ]; then
    file=served.${served##*.}
    ln -sf "$served" "$work/files/$file"
    chmod a+rx "$work" "$work/files" # nginx' worker is of the same user, but not with its rights
    ip link set lo up
    start_server "$round_trips"
    status=0
    "${command[@]//%u/"$url"}" || status=$?
    stop_server
    exit "$status"
fi
"$bin/remote_figures" --make --edge "$edge" "$work/files/tiles.sluice"
ip link set lo up
for round_trip in ${round_trips//,/ }; do
    say "round trip of $round_trip ms"
    start_server "$round_trip"
    figures --name "round_trip_$round_trip." --round-trip "$round_trip" --requests "$requests"
    stop_server
done
: >"$work/nginx/access.log"
start_server 0
figures --overhead
stop_server
measure_requests >>"$work/figures"

if [ "$json" = yes ]; then
    cat "$work/figures"
    exit 0
fi
sed 's/^{"name": "\([^"]*\)", "value": \([^,]*\), "unit": "\([^"]*\)"}$/\1 \2 \3/' "$work/figures" |
    awk '{
        goal = $1 ~ /ranges.of_plain$/ ? "0.9 at least" : ""
        printf "%-44s %12s %-10s %s\n", $1, $2, $3, goal
    }'
