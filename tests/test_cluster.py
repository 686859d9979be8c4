"""Tasks on a real cluster: a scheduler and two worker processes on this machine.

The law: the bytes of a result do not depend on where its tasks ran, nor on a worker that was killed meanwhile.
"""

import os
import signal
from collections.abc import Sequence

import numpy as np
import pytest
from faults import kill_scheduler
from patience import PATIENCE
from strategies import random_tables

from halfway import Recipe, Route, build_library
from halfway.cluster import Cluster
from halfway.components import Pca
from halfway.errors import ClusterError, FormatError, LibraryError, MissingExtraError
from halfway.export import write_route
from halfway.formats import write_merl
from halfway.halfdiff import Grid
from halfway.judge import Bench, evaluate, leave_one_out
from halfway.library import StoredLibrary
from halfway.look import CellSamples, Looks
from halfway.recipes import Mixer
from halfway.space import LinearSpace, make_space
from halfway.tasks import Threads, Work

GRID = Grid.merl(12, 10, 8)
"""Large enough for several blocks with a patched block size, small enough for milliseconds."""


@pytest.fixture(scope="module", autouse=True)
def patient():
    """Workers take seconds to start, and more on a busy machine."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("halfway.cluster.CONNECTION_SECONDS", PATIENCE)
        patch.setattr("halfway.cluster.LONELY_SECONDS", PATIENCE)
        yield


@pytest.fixture(scope="module")
def address():
    """Of a scheduler with two workers of one thread, each a process that is started again when it dies."""
    import dask
    from distributed import LocalCluster

    options = {
        # A killed worker takes seconds to come back: two deaths prove what four do.
        "distributed.scheduler.allowed-failures": 1,
        # One that is not back in time is given up.
        "distributed.deploy.lost-worker-timeout": f"{PATIENCE:g} s",
    }
    with (
        dask.config.set(options),
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
    ):
        yield cluster.scheduler_address


@pytest.fixture(scope="module")
def cluster(address):
    with Cluster.at(address) as cluster:
        yield cluster


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    source = tmp_path_factory.mktemp("measured")
    for name, table in random_tables(9, GRID).items():
        write_merl(source / f"{name}.binary", table)
    return source


@pytest.fixture(scope="module")
def library(folder):
    return build_library([folder], folder.parent / "small.brdflib").library


def square(x: int) -> int:
    return x * x


def refuse(x: int) -> int:
    raise FormatError(f"{x}.binary is damaged: expected a table. Compare it with the original.")


def die(x: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return x


def files(folder):
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_results_come_in_order(cluster):
    assert list(Work(engine=cluster).run(square, range(50))) == [x * x for x in range(50)]


def test_a_library_is_the_same_bytes(cluster, folder, library, tmp_path):
    build_library([folder], tmp_path / "again.brdflib", work=Work(engine=cluster))
    assert files(tmp_path / "again.brdflib") == files(library.path)


def test_a_library_of_files_named_from_here_is_right_there_too(
    cluster, folder, tmp_path, monkeypatch
):
    monkeypatch.chdir(folder.parent)
    built = build_library([folder.name], tmp_path / "here.brdflib", work=Work(engine=cluster))
    assert built.library.verify(work=Work(engine=cluster)) == (9, (), ())


def test_components_pictures_and_samples_are_the_same_bytes(cluster, library):
    for fit, fields in (
        (Pca.fit, ("eigenvalues", "eigenvectors", "squared_norms")),
        (Looks.fit, ("planes",)),
        (CellSamples.fit, ("values", "body")),
    ):
        here, there = fit(library), fit(library, work=Work(engine=cluster))
        for field in fields:
            np.testing.assert_array_equal(getattr(here, field), getattr(there, field))


def test_tables_of_a_route_are_the_same_bytes(cluster, library, tmp_path):
    route = Route.through(LinearSpace.of(library), library.names[:3])
    ts = np.linspace(0, 1, 7).tolist()
    write_route(tmp_path / "here", route, ts, library, format="merl")
    write_route(tmp_path / "there", route, ts, library, format="merl", work=Work(engine=cluster))
    assert files(tmp_path / "there") == files(tmp_path / "here")
    assert len(files(tmp_path / "there")) == 9


def test_a_space_measures_the_same(cluster, library):
    space, bench = make_space("paper", library), Bench.fit(library)
    pairs = np.array([[0, 1], [2, 3]])
    here, there = (
        (
            evaluate(space, bench, pairs, work=Work(engine=engine)).to_json(),
            leave_one_out(space, bench, work=Work(engine=engine)).to_json(),
        )
        for engine in (Threads(), cluster)
    )
    assert here == there


@pytest.fixture
def kill_one(cluster):
    """A track that kills a worker (SIGKILL) when the third result is there."""

    def track(items, label, total):  # noqa: ARG001
        for i, item in enumerate(items):
            if i == 2:
                os.kill(min(cluster.client.run(os.getpid).values()), signal.SIGKILL)
            yield item

    return track


def test_components_are_the_same_bytes_when_a_worker_is_killed(
    cluster, library, kill_one, monkeypatch
):
    blocks = [slice(start, start + 40) for start in range(0, GRID.size, 40)]
    monkeypatch.setattr(StoredLibrary, "blocks", lambda _: blocks)
    here, there = (
        Pca.fit(library),
        Pca.fit(library, work=Work(engine=cluster, track=kill_one)),
    )
    np.testing.assert_array_equal(here.eigenvectors, there.eigenvectors)
    np.testing.assert_array_equal(here.eigenvalues, there.eigenvalues)


def test_tables_are_the_same_bytes_when_a_worker_is_killed(cluster, library, kill_one, tmp_path):
    route = Route.through(LinearSpace.of(library), library.names[:3])
    ts = np.linspace(0, 1, 24).tolist()
    write_route(tmp_path / "here", route, ts, library, format="merl")
    write_route(
        tmp_path / "there",
        route,
        ts,
        library,
        format="merl",
        work=Work(engine=cluster, track=kill_one),
    )
    assert files(tmp_path / "there") == files(tmp_path / "here")


def test_a_mistake_is_the_same_mistake(cluster):
    with pytest.raises(FormatError, match=r"^0\.binary is damaged: expected a table\."):
        list(Work(engine=cluster).run(refuse, range(3)))


class Counted(Sequence[int]):
    """The numbers below 100, that knows how many were taken."""

    def __init__(self) -> None:
        self.n_taken = 0

    def __len__(self):
        return 100

    def __getitem__(self, i):
        if i >= 100:
            raise IndexError(i)
        self.n_taken = i + 1
        return i


def test_few_results_wait(cluster):
    """Back-pressure: what nobody took yet is bounded, on a cluster as on threads."""
    for engine, bound in ((Threads(2), 4), (cluster, 7)):
        tasks = Counted()
        results = Work(engine=engine).run(square, tasks)
        next(results)
        assert tasks.n_taken <= bound
        results.close()


def test_a_library_travels_as_its_path(library):
    import pickle

    assert len(pickle.dumps(library)) < 500
    again = pickle.loads(pickle.dumps(library))
    np.testing.assert_array_equal(again.row(3), library.row(3))
    recipe = Recipe.of(library.name, {library.names[0]: 0.5, library.names[1]: 0.5})
    mixer = pickle.loads(pickle.dumps(Mixer(library)))
    np.testing.assert_array_equal(mixer.mix(recipe).values, Mixer(library).mix(recipe).values)


def test_a_library_that_changed_on_the_way_is_refused(folder, tmp_path):
    import pickle

    first = build_library([folder], tmp_path / "x.brdflib").library
    packed = pickle.dumps(first)
    other = tmp_path / "other"
    write_merl(other / "only.binary", random_tables(1, GRID, seed=3)["material-0"])
    build_library([other], tmp_path / "x.brdflib")
    with pytest.raises(LibraryError, match="it was made again, or is another on this machine"):
        pickle.loads(packed)
    with pytest.raises(LibraryError, match="is gone: it was there when the library was opened"):
        first.row(0)


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("tcp://127.0.0.1:1", r"tcp://127\.0\.0\.1:1 cannot be reached \(Timed out"),
        ("localhost", r"cannot be reached \(missing port number"),
        ("http://localhost:8786", r"cannot be reached \(unknown address scheme 'http'"),
    ],
)
def test_an_address_without_a_scheduler_is_one_line(monkeypatch, address, message):
    monkeypatch.setattr("halfway.cluster.CONNECTION_SECONDS", 1.0)
    with pytest.raises(ClusterError, match=message), Cluster.at(address):
        pass


def test_a_scheduler_without_workers_is_one_line(monkeypatch):
    from distributed import LocalCluster

    monkeypatch.setattr("halfway.cluster.CONNECTION_SECONDS", 2.0)
    with (
        LocalCluster(n_workers=0, dashboard_address=":0") as empty,
        pytest.raises(ClusterError, match=r"has 0 workers after 2 s: expected at least one"),
        Cluster.at(empty.scheduler_address),
    ):
        pass


def test_workers_that_stay_away_are_told_of_and_one_that_comes_is_waited_for(monkeypatch):
    from distributed import Client, LocalCluster

    monkeypatch.setattr("halfway.cluster.LOOK_SECONDS", 0.1)
    monkeypatch.setattr("halfway.cluster.LONELY_SECONDS", 1.0)
    with (
        LocalCluster(n_workers=0, dashboard_address=":0") as empty,
        Client(empty.scheduler_address, set_as_default=False) as client,
    ):
        with pytest.raises(ClusterError, match=r"has had no worker for 1 s: expected some that"):
            list(Work(engine=Cluster(client)).run(square, range(1)))
        monkeypatch.setattr("halfway.cluster.LONELY_SECONDS", PATIENCE)
        results = Work(engine=Cluster(client)).run(square, range(9))
        empty.scale(1)
        assert list(results) == [x * x for x in range(9)]


def test_workers_of_another_version_are_refused(cluster, address, monkeypatch):
    import halfway.cluster

    ours = halfway.cluster._versions()
    monkeypatch.setattr("halfway.cluster._versions", lambda: ours | {"halfway": "0.0.1"})
    monkeypatch.setattr(type(cluster.client), "run", lambda *_, **__: {"tcp://w": ours})
    message = rf"workers of {address} have halfway \S+ and here is 0\.0\.1: expected the same"
    with pytest.raises(ClusterError, match=message), Cluster.at(address):
        pass
    monkeypatch.setattr("halfway.cluster._versions", lambda: ours | {"numpy": "0.0.1"})
    with pytest.warns(UserWarning, match="results may differ in the last digits"):
        Cluster.at(address).__enter__().client.close()


def test_without_the_package_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    message = r"needs the package distributed.*`pip install distributed`"
    with pytest.raises(MissingExtraError, match=message), Cluster.at("tcp://127.0.0.1:8786"):
        pass


# The last: workers take seconds to come back.
def test_a_task_that_kills_every_worker_is_given_up(cluster):
    with pytest.raises(ClusterError, match="lost 2 workers on one task: expected none to die"):
        list(Work(engine=cluster).run(die, range(1)))


def test_a_scheduler_killed_in_the_middle_is_one_line():
    assert "is gone: the scheduler was there when the work began" in kill_scheduler()
