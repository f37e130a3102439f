#!/usr/bin/env python3
"""A web server that delays, cuts and lies on request.

Prints three ports (web, another web origin, TLS or 0) and serves until its standard input ends.

The path says what goes wrong: /FAULT/NAME?size=BYTES&from=N&count=N. The fault hits requests number
`from` to `from` + `count` - 1 of this path and query; the first one, which opens the file, is 0. Byte
i of every file is ((i * 2654435761) >> 13) & 255, so that nobody needs the file to check it. Files have up to 1 MiB.
"""
import hashlib
import hmac
import os
import re
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

ACCESS_KEY, SECRET_KEY, TOKEN = 'test:access', 'test/secret', 'token-1'
counts, lock = {}, threading.Lock()
ports = []
quitting = threading.Event()


PERIOD = bytes(((i * 2654435761) >> 13) & 255 for i in range(1 << 20))


def content(first, end):
    return PERIOD[first:end]


def signature(handler, parts, region):
    """The signature of AWS version 4, computed anew from what arrived."""
    found = re.fullmatch(r'AWS4-HMAC-SHA256 Credential=([^,]*), ?SignedHeaders=([^,]*), ?Signature=(\w+)',
                         handler.headers.get('Authorization', ''))
    if not found:
        return None
    key, day, got_region, service, end = found[1].rsplit('/', 4)
    if (key, got_region, service, end) != (ACCESS_KEY, region, 's3', 'aws4_request'):
        return None
    names = found[2].split(';')
    if 'x-amz-content-sha256' not in names or 'host' not in names:
        return None
    lines = ''.join('%s:%s\n' % (n, ' '.join(handler.headers.get(n, '').split())) for n in names)
    asked = '\n'.join(['GET', parts.path, parts.query, lines, found[2],
                       handler.headers.get('x-amz-content-sha256', '')])
    scope = '/'.join([day, region, 's3', 'aws4_request'])
    text = '\n'.join(['AWS4-HMAC-SHA256', handler.headers.get('x-amz-date', ''), scope,
                      hashlib.sha256(asked.encode()).hexdigest()])
    secret = ('AWS4' + SECRET_KEY).encode()
    for word in scope.split('/'):
        secret = hmac.new(secret, word.encode(), hashlib.sha256).digest()
    return found[3], hmac.new(secret, text.encode(), hashlib.sha256).hexdigest()


class Handler(BaseHTTPRequestHandler):
    protocol_version = 'HTTP/1.1'
    disable_nagle_algorithm = True  # a header and its body are two writes

    def log_message(self, *unused):
        pass

    def send(self, status, headers, body, length=None):
        self.send_response_only(status)
        for name, value in headers.items():
            self.send_header(name, value)
        self.send_header('Content-Length', len(body) if length is None else length)
        self.end_headers()
        self.wfile.write(body)

    def asked_range(self, size):
        found = re.fullmatch(r'bytes=(\d+)-(\d+)', self.headers.get('Range', ''))
        first, last = (int(found[1]), int(found[2])) if found else (0, size - 1)
        return first, min(last, size - 1)

    def do_GET(self):
        parts = urllib.parse.urlsplit(self.path)
        query = dict(urllib.parse.parse_qsl(parts.query))
        with lock:
            number = counts.get(self.path, 0)
            counts[self.path] = number + 1
        fault = parts.path.split('/')[1]
        if fault == 'disk':  # /disk/PATH: as `file`, for names that are found beside each other
            query['path'] = urllib.parse.unquote(parts.path)[len('/disk'):]
            fault = 'file'
        size = os.path.getsize(query['path']) if fault == 'file' else int(query.get('size', 1 << 20))
        begin = int(query.get('from', 0))
        hit = begin <= number < begin + int(query.get('count', 1 << 30))
        first, last = self.asked_range(size)
        if first >= size:
            self.send(416, {'Content-Range': 'bytes */%d' % size}, b'')
            return
        headers = {'ETag': '"1"', 'Content-Range': 'bytes %d-%d/%d' % (first, last, size)}
        if 'slow' in query:
            time.sleep(float(query['slow']))
        make = getattr(self, 'fault_' + fault.split('-')[0].replace('.', '_'), None)
        if hit and make:
            make(fault, parts, query, headers, first, last, size)
        else:
            self.send(206, headers, content(first, last + 1))

    def fault_status(self, fault, parts, query, headers, first, last, size):
        extra = {'Retry-After': query['after']} if 'after' in query else {}
        self.send(int(fault.split('-')[1]), extra, b'x' * int(query.get('body', 10)))

    def fault_cut(self, fault, parts, query, headers, first, last, size):
        self.send(206, headers, content(first, (first + last) // 2), last + 1 - first)
        self.close_connection = True

    def fault_short(self, fault, parts, query, headers, first, last, size):
        self.send(206, headers, content(first, (first + last) // 2))

    def fault_long(self, fault, parts, query, headers, first, last, size):
        self.send(206, headers, content(first, last + 1) + b'more')

    def fault_reset(self, fault, parts, query, headers, first, last, size):
        self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        self.close_connection = True
        self.connection.close()

    def fault_shifted(self, fault, parts, query, headers, first, last, size):
        headers['Content-Range'] = 'bytes %d-%d/%d' % (first + 1, last + 1, size + 1 if last + 1 == size else size)
        self.send(206, headers, content(first + 1, last + 1) + b'?')

    def fault_norange(self, fault, parts, query, headers, first, last, size):
        del headers['Content-Range']
        self.send(206, headers, content(first, last + 1))

    def fault_star(self, fault, parts, query, headers, first, last, size):
        headers['Content-Range'] = 'bytes %d-%d/*' % (first, last)
        self.send(206, headers, content(first, last + 1))

    def fault_whole(self, fault, parts, query, headers, first, last, size):
        self.send(200, {'ETag': '"1"'}, content(0, size))

    def fault_gzip(self, fault, parts, query, headers, first, last, size):
        headers['Content-Encoding'] = 'gzip'
        self.send(206, headers, content(first, last + 1))

    def fault_etag(self, fault, parts, query, headers, first, last, size):
        headers['ETag'] = '"2"'
        if self.headers.get('If-Match') == '"1"' and 'careless' not in query:
            self.send(412, {}, b'')
        else:
            self.send(206, headers, content(first, last + 1))

    def fault_dated(self, fault, parts, query, headers, first, last, size):
        """No ETag; the date of the second version differs."""
        del headers['ETag']
        late = int(query.get('late', 1 << 30)) <= counts[self.path] - 1
        headers['Last-Modified'] = 'Mon, 02 Nov 2026 10:00:0%d GMT' % late
        self.send(206, headers, content(first, last + 1))

    def fault_fresh(self, fault, parts, query, headers, first, last, size):
        """Answered `age` seconds after the file was written."""
        headers['Last-Modified'] = 'Mon, 02 Nov 2026 10:00:00 GMT'
        headers['Date'] = 'Mon, 02 Nov 2026 10:00:0%s GMT' % query['age']
        self.send(206, headers, content(first, last + 1))

    def fault_untagged(self, fault, parts, query, headers, first, last, size):
        del headers['ETag']
        self.send(206, headers, content(first, last + 1))

    def fault_size(self, fault, parts, query, headers, first, last, size):
        headers['Content-Range'] = 'bytes %d-%d/%d' % (first, last, size + 1)
        self.send(206, headers, content(first, last + 1))

    def fault_stall(self, fault, parts, query, headers, first, last, size):
        self.send(206, headers, content(first, first + 10), last + 1 - first)
        self.wfile.flush()
        quitting.wait(20)
        self.close_connection = True

    def fault_drip(self, fault, parts, query, headers, first, last, size):
        self.send(206, headers, b'', last + 1 - first)
        for i in range(first, last + 1):
            self.wfile.write(content(i, i + 1))
            if quitting.wait(0.02):
                break
        self.close_connection = True

    def fault_garbage(self, fault, parts, query, headers, first, last, size):
        self.wfile.write(b'\x00\x01no http\r\n\r\n')
        self.close_connection = True

    def fault_redirect(self, fault, parts, query, headers, first, last, size):
        kind = fault.split('-')[1]
        if kind == 'chunked':
            self.send_response_only(302)
            self.send_header('Location', '/plain/x?' + parts.query)
            self.send_header('Transfer-Encoding', 'chunked')
            self.end_headers()
            self.wfile.write(b'9\r\nelsewhere\r\n0\r\n\r\n')
            return
        web = 'http://127.0.0.1:%d' % (ports[1] if kind == 'away' else ports[0])
        place = {'loop': self.path, 'away': web + '/bare/x?' + parts.query, 'file': 'file:///etc/passwd',
                 'here': '/plain/x?' + parts.query,
                 'expiring': '/status-403/x?from=2&turn=%d' % counts[self.path], 'web': web + '/plain/x'}[kind]
        self.send(302, {'Location': place}, b'elsewhere')

    def fault_key(self, fault, parts, query, headers, first, last, size):
        status = 206 if self.headers.get('X-Key') == 'secret' else 401
        self.send(status, headers, content(first, last + 1) if status == 206 else b'')

    def fault_bare(self, fault, parts, query, headers, first, last, size):
        status = 400 if 'X-Key' in self.headers else 206
        self.send(status, headers, content(first, last + 1) if status == 206 else b'')

    def fault_file(self, fault, parts, query, headers, first, last, size):
        """A file of the disk; every so many requests, from the second one on, a body is cut."""
        every = int(query.get('every', 0))
        with open(query['path'], 'rb') as file:
            file.seek(first)
            body = file.read(last + 1 - first)
        if every and counts[self.path] % every == 0:
            self.send(206, headers, body[:len(body) // 2], len(body))
            self.close_connection = True
        else:
            self.send(206, headers, body)

    def fault_bucket(self, fault, parts, query, headers, first, last, size):
        pair = signature(self, parts, 'mars-1')
        token = self.headers.get('x-amz-security-token')
        if not pair or pair[0] != pair[1] or token != TOKEN:
            self.send(403, {}, b'')
        else:
            self.send(206, headers, content(first, last + 1))


class Server(ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 128

    def handle_error(self, *unused):
        pass


def make_certificate(folder):
    names = [os.path.join(folder, n) for n in ('key.pem', 'certificate.pem')]
    subprocess.run(['openssl', 'req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-keyout', names[0], '-out', names[1],
                    '-days', '2', '-subj', '/CN=127.0.0.1', '-addext', 'subjectAltName=IP:127.0.0.1'],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return names


def main():
    servers = [Server(('127.0.0.1', 0), Handler) for _ in range(3)]
    ports.extend(s.server_address[1] for s in servers)
    folder = tempfile.TemporaryDirectory()
    certificate = '-'
    try:
        key, certificate = make_certificate(folder.name)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key)
        servers[2].socket = context.wrap_socket(servers[2].socket, server_side=True)
    except (OSError, subprocess.CalledProcessError):
        ports[2] = 0
    for server in servers:
        threading.Thread(target=server.serve_forever, daemon=True).start()
    print(*ports, certificate, flush=True)
    sys.stdin.read()
    quitting.set()
    folder.cleanup()


main()
