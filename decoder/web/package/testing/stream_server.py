"""A web server for tests: files of a folder, with ranges or without, and what was asked of it."""

import contextlib
import http.server
import pathlib
import re
import threading
import time

TYPES = {".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm"}


ENDLESS_BYTES = 1 << 26  # of a body without end; a reader that is sound stops long before


def reply(handler, status, body, headers):
    handler.send_response(status)
    handler.send_header("Cache-Control", "no-store")
    for name, value in headers.items():
        handler.send_header(name, value)
    handler.end_headers()
    handler.close_connection = True
    if handler.command != "HEAD":
        handler.wfile.write(body)


def lie(handler, data, numbers):
    """One wrong reply, of a kind that `numbers` choose."""
    wanted = re.fullmatch(r"bytes=(\d+)-(\d+)", handler.headers.get("Range", ""))
    first, last = (int(wanted[1]), int(wanted[2])) if wanted else (0, len(data) - 1)
    last = min(last, len(data) - 1)
    body = data[first:last + 1]
    size = len(data)
    kind = numbers.randrange(10)
    if kind == 0:
        reply(handler, numbers.choice([404, 403, 500, 503, 416, 204]), b"", {})
        return
    if kind == 1:  # ends early
        reply(handler, 206, body[:numbers.randrange(len(body) + 1)],
              {"Content-Range": f"bytes {first}-{last}/{size}", "Content-Length": len(body)})
        return
    if kind == 2:  # another place
        start = numbers.randrange(size)
        body = data[start:start + len(body)]
        first, last = numbers.choice([(start, start + len(body) - 1), (first, last)])
    elif kind == 3:  # another size of the file
        size = numbers.choice([0, 1, last, size - 1, size + 1, 2 * size, 1 << 53, 1 << 64])
    elif kind == 4:  # without end
        handler.send_response(206)
        handler.send_header("Content-Range", f"bytes {first}-{last}/{size}")
        handler.end_headers()
        handler.close_connection = True
        for _ in range(0 if handler.command == "HEAD" else ENDLESS_BYTES >> 16):
            handler.wfile.write(bytes(1 << 16))
        return
    elif kind == 5:  # the whole file
        reply(handler, 200, data, {"Content-Length": size})
        return
    elif kind == 6:  # damaged
        body = bytearray(body)
        for _ in range(min(8, len(body))):
            body[numbers.randrange(len(body))] ^= 1 << numbers.randrange(8)
    elif kind == 7:  # a header that is none
        reply(handler, 206, body, {"Content-Range": numbers.choice(
            ["", "bytes", "bytes */*", f"bytes {last}-{first}/{size}", "bytes -1-5/x"])})
        return
    elif kind == 8:  # longer than asked for
        body = data[first:] + data
    reply(handler, 206, bytes(body), {
        "Content-Range": f"bytes {first}-{last}/{size}", "Content-Length": len(body),
        "ETag": f'"{numbers.randrange(3)}"'})


class StreamServer:
    """with StreamServer(folder) as server: server.address, server.requests"""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.ranges = True  # whether it has ranges
        self.bytes_per_second = 0  # 0: as fast as it can
        self.cut_at = None  # ends each body of a stream after so many bytes
        self.changes = False  # whether streams have another version at each request
        self.is_open = False  # whether pages of other origins may read it
        self.lies = None  # a random.Random: most replies about streams are wrong, each in a way
        self.requests = []  # of streams: (method, first byte, bytes sent, status)

    def __enter__(self):
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                outer.answer(self)

            def do_HEAD(self):
                outer.answer(self)

            def log_message(self, *_):
                pass

        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.address = f"http://127.0.0.1:{self._server.server_address[1]}"
        self._thread = threading.Thread(target=self._server.serve_forever)
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()

    def sent(self):
        """Bytes of streams that were sent."""
        return sum(num_bytes for _, _, num_bytes, _ in self.requests)

    def answer(self, handler):
        path = self.folder / handler.path.partition("?")[0].lstrip("/")
        if not path.is_file():
            handler.send_error(404, "Not Found")
            return
        data = path.read_bytes()
        is_stream = path.suffix == ".rlpc"
        if is_stream and self.lies is not None and self.lies.random() < 0.7:
            with contextlib.suppress(OSError):  # the browser wants no more
                lie(handler, data, self.lies)
            return
        first, end, status = 0, len(data), 200
        wanted = re.fullmatch(r"bytes=(\d+)-(\d+)", handler.headers.get("Range", ""))
        if wanted and self.ranges and is_stream:
            first, end, status = int(wanted[1]), min(len(data), int(wanted[2]) + 1), 206
        if first >= len(data) and status == 206:
            status, first, end = 416, 0, 0
        handler.send_response(status)
        handler.send_header("Content-Type", TYPES.get(path.suffix, "application/octet-stream"))
        handler.send_header("Content-Length", str(end - first))
        handler.send_header("ETag", f'"{len(self.requests) if self.changes else 0}"')
        handler.send_header("Cache-Control", "no-store")
        if self.is_open:
            handler.send_header("Access-Control-Allow-Origin", "*")
        if status == 206:
            handler.send_header("Content-Range", f"bytes {first}-{end - 1}/{len(data)}")
        handler.end_headers()
        if is_stream:
            self.requests.append((handler.command, first, end - first, status))
        if handler.command == "HEAD":
            return
        try:
            self.send(handler, data[first:end], is_stream)
        except OSError:
            pass  # the browser wants no more

    def send(self, handler, body, is_stream):
        if is_stream and self.cut_at is not None:
            handler.wfile.write(body[:self.cut_at])
            handler.close_connection = True
        elif is_stream and self.bytes_per_second:
            step = max(1, self.bytes_per_second // 20)
            for at in range(0, len(body), step):
                handler.wfile.write(body[at:at + step])
                time.sleep(0.05)
        else:
            handler.wfile.write(body)
