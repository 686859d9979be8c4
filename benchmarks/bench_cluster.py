"""What a cluster costs and brings on one machine: a task on two worker processes, and the same work on them and on threads."""

import numpy as np
import pytest
from racing import race, ratio

from halfway.cluster import Cluster
from halfway.components import Pca
from halfway.halfdiff import Grid
from halfway.judge import Bench, evaluate, sample_pairs
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.space import LinearSpace
from halfway.tasks import Engine, Threads, Work

N_TASKS = 500


@pytest.fixture(scope="module")
def cluster():
    """Two worker processes of one thread each."""
    from distributed import LocalCluster

    local = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0")
    with local, Cluster.at(local.scheduler_address) as cluster:
        yield cluster


def nothing(_: int) -> None:
    """A task without work."""


def bench_tasks_on_a_cluster(figures, cluster: Cluster):
    def tasks(engine: Engine) -> None:
        list(Work(engine=engine).run(nothing, range(N_TASKS)))

    seconds = race(lambda: tasks(cluster), lambda: tasks(Threads()), rounds=3)
    figures.note(
        f"{N_TASKS} empty tasks on 2 Dask workers",
        "ours / threads",
        ratio(seconds, 0, 1),
        note=f"{1e3 * np.median(seconds[:, 0]) / N_TASKS:.1f} ms a task",
    )


def bench_components_on_a_cluster(figures, cluster: Cluster, library):
    fits = (lambda: Pca.fit(library, work=Work(engine=cluster)), lambda: Pca.fit(library))
    seconds = race(*fits, rounds=3)
    figures.note(
        "components of 100 materials on 2 Dask workers",
        "ours / threads",
        ratio(seconds, 0, 1),
        note=f"{np.median(seconds[:, 0]):.1f} s",
    )


def bench_pairs_on_a_cluster(figures, cluster: Cluster):
    """Pairs hold Python's lock for a part of their time: whether processes pay."""
    grid = Grid.merl(30, 30, 60)
    library = ProceduralLibrary("small", builtin("merl-abc").models, grid=grid)
    bench, space = Bench.fit(library), LinearSpace.of(library)
    pairs = sample_pairs(len(library), 40)
    engines = (cluster, Threads())
    seconds = race(
        *(
            lambda engine=engine: evaluate(space, bench, pairs, work=Work(engine=engine))
            for engine in engines
        ),
        rounds=2,
    )
    figures.note(
        "40 pairs of a space on 2 Dask workers",
        "ours / threads",
        ratio(seconds, 0, 1),
        note=f"{np.median(seconds[:, 0]) / len(pairs):.2f} s a pair",
    )
