"""The server's API over the messages between a widget and its kernel: no port is opened, so it works wherever the notebook does.

    to the kernel     {"id": 7, "method": "GET", "path": "api/library", "body": null}
    from the kernel   {"id": 7, "status": 200, "headers": {...}} and one buffer, the body

The application is called in this process, as a web server would call it. While the kernel runs a cell, messages wait.
"""

import asyncio
from collections.abc import Callable
from typing import Any

import httpx
from fastapi import FastAPI

Send = Callable[[dict[str, Any], list[bytes]], None]
ORIGIN = "http://localhost"
HEADERS = ("content-type", "halfway-shape", "halfway-scale", "halfway-summary")
"""What the page reads of an answer's headers."""


class Answerer:
    """Answers a widget's messages; ``send`` takes the content and the buffers of each answer."""

    def __init__(self, app: FastAPI, send: Send) -> None:
        # A fault is answered with 500, as a server does.
        self._transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        self._send = send
        self._running: set[asyncio.Task[None]] = set()

    def receive(self, message: dict[str, Any]) -> None:
        """Answer one message: later, where the kernel's loop runs, or at once."""
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            asyncio.run(self._answer(message))
            return
        # The loop itself holds a task weakly.
        task = loop.create_task(self._answer(message))
        self._running.add(task)
        task.add_done_callback(self._running.discard)

    async def _answer(self, message: dict[str, Any]) -> None:
        async with httpx.AsyncClient(transport=self._transport, base_url=ORIGIN) as client:
            answer = await client.request(
                message["method"],
                f"/{message['path']}",
                content=message["body"],
                # Within this process nothing is won by compressing.
                headers={"Content-Type": "application/json", "Accept-Encoding": "identity"},
            )
        headers = {name: answer.headers[name] for name in HEADERS if name in answer.headers}
        head = {"id": message["id"], "status": answer.status_code, "headers": headers}
        self._send(head, [answer.content])
