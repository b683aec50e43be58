"""Sweeps on Dask's distributed scheduler: two worker processes, one of which is killed in the middle."""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path

import pytest
from conftest import Write
from sweep_measures import MOVE, VARIATIONS, following

import cc67

distributed = pytest.importorskip("distributed")


@pytest.mark.skipif(os.name == "nt", reason="workers are killed by a signal")
def test_a_sweep_on_dask_survives_the_loss_of_a_worker(write: Write, tmp_path: Path) -> None:
    program = cc67.compile(write(MOVE))
    wanted = cc67.sweep(program, VARIATIONS, following)
    os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    log = tmp_path / "sweep.log"
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True)
    with cluster, distributed.Client(cluster) as client:
        victim = min(client.run(os.getpid).values())

        def kill() -> None:
            while not (log.exists() and log.read_text().count("\n") > 20):
                time.sleep(0.005)
            os.kill(victim, signal.SIGKILL)

        thread = threading.Thread(target=kill)
        thread.start()
        table = cc67.sweep(program, VARIATIONS, following, executor=client.get_executor(), log=log)
        thread.join()
        assert victim not in client.run(os.getpid).values()
    assert table == wanted
