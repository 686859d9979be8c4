"""A real HTTP server on loopback that does everything wrong, one thing at a time."""

import hashlib
import threading
import time
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from halfway.fetch.catalogue import TENSOR_FILE

BODY = TENSOR_FILE + bytes(range(256)) * 400
N_BYTES = len(BODY)
NAME = "clay.bsdf"
MD5 = hashlib.md5(BODY).hexdigest()


class Server(ThreadingHTTPServer):
    """Answers each request with the next of ``answers``, the last one for ever."""

    daemon_threads = True

    def __init__(self, answers):
        super().__init__(("127.0.0.1", 0), Handler)
        self.answers = list(answers)
        self.stopped = threading.Event()
        self.requests = []

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_port}"


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_GET(self):
        server = self.server
        server.requests.append(dict(self.headers))
        answer = server.answers.pop(0) if len(server.answers) > 1 else server.answers[0]
        self.close_connection = True
        answer(self)

    def log_message(self, *_):
        pass

    def begin(self, code, headers=()):
        self.send_response(code)
        for name, value in dict(headers).items():
            self.send_header(name, str(value))
        self.send_header("Connection", "close")
        self.end_headers()


# What the server does


def good(handler, *, body=BODY, etag='"v1"'):
    """Byte ranges, as a server should."""
    asked = handler.headers.get("Range")
    if asked and handler.headers.get("If-Range", etag) == etag:
        start = int(asked.removeprefix("bytes=").removesuffix("-"))
        if start >= len(body):
            return handler.begin(416, {"Content-Length": 0})
        handler.begin(206, {
            "Content-Length": len(body) - start,
            "Content-Range": f"bytes {start}-{len(body) - 1}/{len(body)}",
            "ETag": etag,
        })  # fmt: skip
        return handler.wfile.write(body[start:])
    handler.begin(200, {"Content-Length": len(body), "ETag": etag})
    return handler.wfile.write(body)


def cut(n, etag='"v1"'):
    def answer(handler):
        handler.begin(200, {"Content-Length": len(BODY), "ETag": etag})
        handler.wfile.write(BODY[:n])

    return answer


def cut_and_resume(handler):
    """Sends some more each time, and then hangs up."""
    start = int(handler.headers.get("Range", "bytes=0-").removeprefix("bytes=").removesuffix("-"))
    if not start:
        return cut(30_000)(handler)
    handler.begin(206, {"Content-Length": len(BODY) - start, "Content-Range": f"bytes {start}-{len(BODY) - 1}/{len(BODY)}"})  # fmt: skip
    return handler.wfile.write(BODY[start : start + 30_000])


def status(code, headers=()):
    return lambda handler: handler.begin(code, {"Content-Length": 0, **dict(headers)})


def body(content, headers=()):
    def answer(handler):
        handler.begin(200, {"Content-Length": len(content), **dict(headers)})
        handler.wfile.write(content)

    return answer


def without_length(content):
    def answer(handler):
        handler.begin(200)
        handler.wfile.write(content)

    return answer


def stall(handler):
    handler.begin(200, {"Content-Length": len(BODY)})
    handler.wfile.write(BODY[:100])
    handler.wfile.flush()
    handler.server.stopped.wait()


def trickle(handler):
    handler.begin(200, {"Content-Length": len(BODY)})
    for i in range(12):
        handler.wfile.write(BODY[i : i + 1])
        handler.wfile.flush()
        time.sleep(0.05)


def hang_up(handler):
    handler.connection.close()


def ignores_ranges(handler):
    handler.begin(200, {"Content-Length": len(BODY)})
    handler.wfile.write(BODY)


def wrong_range(handler):
    handler.begin(206, {"Content-Length": 10, "Content-Range": f"bytes 5-14/{len(BODY)}"})
    handler.wfile.write(BODY[5:15])


@contextmanager
def serving(*answers):
    server = Server(answers)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.stopped.set()
        server.shutdown()
        server.server_close()
