"""How the explorer is served: to whom, how much, until when."""

import socket
import threading
import urllib.request

import pytest
from fastapi.testclient import TestClient
from patience import PATIENCE
from served import HOST, PAGE, client_of

from halfway.library import ProceduralLibrary
from halfway.server import create_app
from halfway.server.guard import MAX_BODY


@pytest.fixture(scope="module")
def client(small_library: ProceduralLibrary) -> TestClient:
    return client_of(small_library)


def test_another_name_for_this_machine_is_refused(client: TestClient) -> None:
    answer = client.get("/api/library", headers={"Host": "attacker.example:8765"})
    assert answer.status_code == 421
    assert "attacker.example" in answer.json()["error"]


def test_a_page_of_another_origin_is_refused(client: TestClient) -> None:
    assert client.get("/api/library", headers={"Origin": HOST}).status_code == 200
    assert (
        client.get("/api/library", headers={"Origin": "https://attacker.example"}).status_code
        == 403
    )
    assert client.get("/api/library", headers={"Origin": "null"}).status_code == 403


def test_a_request_that_is_too_large_is_refused(client: TestClient) -> None:
    answer = client.post("/api/export/merl", content=b" " * (MAX_BODY + 1))
    assert answer.status_code == 413


def test_a_fault_of_ours_is_one_line_too(
    small_library: ProceduralLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = TestClient(create_app(small_library), base_url=HOST, raise_server_exceptions=False)
    monkeypatch.setattr(ProceduralLibrary, "row", lambda *_: 1 / 0)
    answer = client.get("/api/tables/material-5")
    assert answer.status_code == 500
    assert "ZeroDivisionError" in answer.json()["error"]


def test_the_page_runs_only_its_own_code(client: TestClient) -> None:
    answer = client.get("/")
    assert answer.content == PAGE.assets["index.html"].body
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self'" in policy
    assert "unsafe" not in policy


def test_it_is_served_over_http_until_stopped(small_library: ProceduralLibrary) -> None:
    import uvicorn

    from halfway.server.run import listen

    with listen(0) as listener:
        config = uvicorn.Config(create_app(small_library, page=PAGE), log_level="error")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, args=([listener],), daemon=True)
        thread.start()
        address = f"http://127.0.0.1:{listener.getsockname()[1]}/"
        with urllib.request.urlopen(address, timeout=PATIENCE) as answer:
            assert answer.read() == b"<!doctype html>"
        server.should_exit = True
        thread.join(PATIENCE)
        assert not thread.is_alive()


def test_a_port_that_is_taken_is_replaced_by_a_free_one() -> None:
    from halfway.server.run import listen

    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with listen(port) as listener:
            assert listener.getsockname()[1] != port
