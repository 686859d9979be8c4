"""Serve the explorer on this machine until Ctrl-C."""

import socket
import sys
import threading
import webbrowser
from contextlib import suppress

from ..errors import HalfwayError
from ..library import Library
from ..tasks import HERE, Work
from .page import Page

PORT = 8765
PATIENCE = 0.5
"""Seconds that an answer may take before the page is told how far it is."""


def serve(
    library: Library, *, port: int = PORT, open_browser: bool = True, work: Work = HERE
) -> None:
    """Show ``library`` in the browser; returns when interrupted.

    Loopback only. ``port`` 0, or one that is taken, gives a free one; the address is printed to stderr.

    Raises
    ------
    HalfwayError
        When this installation has no page, or no port can be had.
    """
    with listen(port) as listener:
        page = Page.load()
        had = listener.getsockname()[1]
        if port not in (0, had):
            print(f"note: port {port} is taken, so this is {had}", file=sys.stderr)
        address = f"http://127.0.0.1:{had}/"
        print(f"{library.name}: {address} (Ctrl-C stops)", file=sys.stderr, flush=True)
        if open_browser:
            # The socket listens already: the browser starts meanwhile, and waits until the first answer.
            threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()
        import uvicorn

        from .app import create_app

        app = create_app(library, page=page, work=work, warm=True, patience=PATIENCE)
        config = uvicorn.Config(
            app, log_level="warning", access_log=False, timeout_graceful_shutdown=1
        )
        # It stops cleanly, and then raises the signal again.
        with suppress(KeyboardInterrupt):
            uvicorn.Server(config).run(sockets=[listener])


def listen(port: int) -> socket.socket:
    """A socket that listens on the loopback address: at ``port``, or at a free one when that is taken."""
    if not 0 <= port < 1 << 16:
        raise HalfwayError(f"{port} is no port: expected 1 to 65535, or 0 for any free one.")
    for candidate in dict.fromkeys((port, 0)):
        listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        # A port in use by another program is not shared, on any system.
        if sys.platform != "win32":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind(("127.0.0.1", candidate))
        except OSError:
            listener.close()
            continue
        listener.listen(128)
        return listener
    raise HalfwayError(
        "the explorer found no free port on 127.0.0.1: close a program that listens there."
    )
