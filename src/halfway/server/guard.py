"""What stands between the network and the application.

- Only requests that name this machine get in. A page of another site can make the browser ask for
  ``http://attacker.example:8765``, with that name's address changed to 127.0.0.1 (DNS rebinding); its Host header still says
  ``attacker.example``.
- A request from another origin is refused, and a body has a bounded size.
- Every answer carries a content security policy: the page loads nothing from elsewhere and runs in no frame.
"""

import json
from collections.abc import Iterable

from starlette.types import ASGIApp, Message, Receive, Scope, Send

MAX_BODY = 1 << 20
"""Bytes of a request's body: a recipe of a thousand materials takes 50,000."""
MAX_FILE = 1 << 27
"""Bytes of a measurement: a MERL file takes 35 MB."""
FILES = "/api/materials/"
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")
META_POLICY = "; ".join(
    [
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' blob: data:",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
    ]
)
"""What a page can say of itself; who may frame it, only a header can."""
POLICY = f"{META_POLICY}; frame-ancestors 'none'"
HEADERS = {
    "Content-Security-Policy": POLICY,
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class Guard:
    """Lets in what comes from this machine's own page, and marks every answer."""

    def __init__(self, app: ASGIApp, hosts: Iterable[str] = LOOPBACK) -> None:
        self._app = app
        self._hosts = frozenset(hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        headers = {
            key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]
        }
        refusal = self._refusal(scope["path"], headers)
        if refusal is not None:
            await _answer(send, *refusal)
            return
        await self._app(scope, receive, _marking(send))

    def _refusal(self, path: str, headers: dict[str, str]) -> tuple[int, str] | None:
        host = headers.get("host", "")
        if _name(host) not in self._hosts:
            return (
                421,
                f"this server answers for {', '.join(sorted(self._hosts))}, not for {host!r}: use the address it printed.",
            )
        origin = headers.get("origin")
        if origin is not None and origin.partition("://")[2] != host:
            return 403, f"a page of {origin} may not use this server: open the explorer's own page."
        if "transfer-encoding" in headers:
            return 411, "a request without a length is refused: send Content-Length."
        length = headers.get("content-length", "0")
        most = MAX_FILE if path.startswith(FILES) else MAX_BODY
        if not length.isdecimal() or int(length) > most:
            return 413, f"a request of {length} bytes is too large: expected at most {most}."
        return None


def _name(host: str) -> str:
    name, colon, port = host.rpartition(":")
    return name if colon and port.isdecimal() else host


def _marking(send: Send) -> Send:
    async def marked(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message["headers"], *_encoded()]}
        await send(message)

    return marked


async def _answer(send: Send, status: int, error: str) -> None:
    body = json.dumps({"error": error}).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    await send(
        {"type": "http.response.start", "status": status, "headers": [*headers, *_encoded()]}
    )
    await send({"type": "http.response.body", "body": body})


def _encoded() -> list[tuple[bytes, bytes]]:
    return [(key.lower().encode(), value.encode()) for key, value in HEADERS.items()]
