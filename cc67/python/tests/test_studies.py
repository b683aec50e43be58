"""Studies, compared with closed forms."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cc67
from cc67 import studies

ROOT = Path(__file__).resolve().parents[3]
SERVO = ROOT / "c-programs" / "studies" / "servo.c"
HOME = ROOT / "c-programs" / "studies" / "home.c"

# The default plant of an analog output: 50 units/s per count, with a time constant of 0.02 s.
KU, TAU = 50.0, 0.02


def servo(gain: float, **options: object) -> cc67.Board:
    """Make a board with a servo axis that has the default plant, a fine encoder and this P."""
    board = cc67.Board(
        programs=[SERVO],
        machine=SERVO.with_suffix(".toml"),
        set={"persist.float.10": gain},
        **options,  # type: ignore[arg-type]
    )
    board.run()
    return board


def damped(gain: float) -> tuple[float, float]:
    """Return natural frequency in rad/s and damping of the loop closed by P around the plant K / (s (tau s + 1))."""
    omega = np.sqrt(gain * KU / TAU)
    return float(omega), float(1 / (2 * TAU * omega))


def test_figures_of_a_known_response() -> None:
    omega, zeta = 40.0, 0.4
    time = np.arange(0, 1, 90e-6)
    wd, phi = omega * np.sqrt(1 - zeta**2), np.arccos(zeta)
    values = 5 + 3 * (1 - np.exp(-zeta * omega * time) / np.sqrt(1 - zeta**2) * np.sin(wd * time + phi))
    figures = studies.step_figures(time, values, 8.0)
    assert figures.overshoot == pytest.approx(np.exp(-np.pi * zeta / np.sqrt(1 - zeta**2)), rel=1e-6)
    assert figures.peak_time == pytest.approx(np.pi / wd, rel=1e-4)
    assert abs(figures.error) < 1e-4
    outside = time[np.abs(values - 8) > 0.06][-1]
    assert figures.settling == pytest.approx(outside, abs=90e-6)


def test_figures_of_a_first_order_response() -> None:
    time = np.arange(0, 2, 1e-3)
    figures = studies.step_figures(time, 1 - np.exp(-time / 0.1), 1.0)
    assert figures.rise == pytest.approx(0.1 * np.log(9), rel=1e-3) and figures.overshoot == 0
    assert figures.settling == pytest.approx(0.1 * np.log(50), rel=1e-3)


@pytest.mark.parametrize("gain", [0.5, 1.0])
def test_the_step_response_is_that_of_the_closed_form(gain: float) -> None:
    response = studies.step_response(servo(gain), 0, size=1000.0, seconds=0.5)
    omega, zeta = damped(gain)
    # On the board, the output of a tick acts from the next tick on; the closed form neglects this delay.
    time = response.time
    roots = np.roots([1, 2 * zeta * omega, omega**2]).astype(complex)
    a, b = roots if abs(roots[0] - roots[1]) > 1e-6 else (roots[0], roots[1] * (1 + 1e-6))
    closed = (1 + (b * np.exp(a * time) - a * np.exp(b * time)) / (a - b)).real
    found = response.position / 1000.0
    assert np.max(np.abs(found - closed)) < 0.01
    expected = studies.step_figures(time, closed, 1.0)
    assert response.figures.rise == pytest.approx(expected.rise, rel=0.01)
    assert response.figures.overshoot == pytest.approx(expected.overshoot, abs=0.01)
    # The analog output has whole counts, so the axis can rest with an error of up to a count, 1 / P units.
    assert abs(response.figures.error) < 1.0 / gain


@pytest.mark.parametrize("gain", [0.5, 1.0])
def test_the_frequency_response_is_that_of_the_closed_form(gain: float) -> None:
    frequencies = [0.5, 1, 2, 5, 8, 10, 15, 20]
    found = studies.frequency_response(servo(gain), 0, frequencies, size=1000.0, seconds=1.2)
    omega, zeta = damped(gain)
    s = 2j * np.pi * np.array(frequencies)
    closed = omega**2 / (s**2 + 2 * zeta * omega * s + omega**2)
    assert np.all(np.abs(found.magnitude / np.abs(closed) - 1) < 0.01)
    assert np.all(np.abs(found.response / closed - 1) < 0.03)
    many = studies.frequency_response(servo(gain), 0, np.linspace(1, 20, 200), size=1000.0, seconds=1.2)
    assert many.bandwidth == pytest.approx(_bandwidth(omega, zeta), rel=0.01)


def _bandwidth(omega: float, zeta: float) -> float:
    square = 1 - 2 * zeta**2
    return float(omega * np.sqrt(square + np.sqrt(square**2 + 1)) / (2 * np.pi))


def test_an_axis_that_does_not_answer_is_refused() -> None:
    with pytest.raises(cc67.Error, match="not enabled"):
        studies.step_response(cc67.Board(), 0)
    board = servo(1.0)
    with pytest.raises(cc67.InputError, match="at most"):
        studies.step_response(board, 0, seconds=10.0)
    with pytest.raises(cc67.InputError, match="frequencies"):
        studies.frequency_response(board, 0, [0.0])


def test_the_following_error_of_a_move() -> None:
    board = servo(1.0)
    board.axes[0].move(2000)
    found = studies.following_error(board, "Slide", 0.5)
    # At constant speed, the following error is speed / (P K).
    fastest = np.max(np.diff(found.trace["dest0"])) / 90e-6
    assert 0 < found.worst < 1.3 * fastest / KU and found.rms < found.worst
    assert found.trace["error"][-1] == pytest.approx(0, abs=5)


def test_times_of_studies_may_be_integers() -> None:
    board = servo(1.0)
    assert len(studies.following_error(board, 0, 1).trace.time) == 11111
    assert studies.step_response(board, 0, 100, 1).time[-1] == pytest.approx(1, abs=2e-4)


def test_the_worst_conditions_are_found(tmp_path: Path) -> None:
    program = cc67.compile(SERVO)

    def study(seconds: float) -> tuple[dict[str, Any], cc67.Table]:
        return studies.worst_following_error(
            program,
            {"axis.0.inertia": [0.5, 1.0, 2.0]},
            seconds=seconds,
            machine=SERVO.with_suffix(".toml"),
            stim=['at 0.02s command "Move0=1000"'],
            log=tmp_path / "study.sweep",
        )

    worst, table = study(0.3)
    assert len(table) == 3 and worst["axis.0.inertia"] == 2.0
    with pytest.raises(cc67.InputError, match="another sweep"):
        study(0.2)


def homed_at(board: cc67.Board) -> float:
    """Return the machine coordinate at which homing has put position 0."""
    if not board.run(20.0):
        raise TimeoutError("not homed")
    return board.axes[0].load - board.axes[0].position


def test_the_tolerance_of_a_homing_program() -> None:
    study = studies.tolerance(
        HOME, {"axis.0.start": (-50.0, 50.0)}, homed_at, samples=6, seed=3, machine=HOME.with_suffix(".toml")
    )
    again = studies.tolerance(
        HOME, {"axis.0.start": (-50.0, 50.0)}, homed_at, samples=6, seed=3, machine=HOME.with_suffix(".toml")
    )
    assert study.table == again.table and len(study.table.failures) == 0
    spread = study.spread("value")
    assert spread["max"] - spread["min"] < 1.0, "homing finds the same place, wherever the axis begins"
    assert study.yield_within("value", -302, -298) == 1.0


def parabola(gains: dict[str, float]) -> float:
    """Return a cost that is lowest at P = 3 and D = -1."""
    return (gains["P"] - 3) ** 2 + 2 * (gains["D"] + 1) ** 2


@pytest.mark.parametrize("method", ["compass", "Nelder-Mead", "differential_evolution"])
def test_gains_are_searched_within_limits(method: str) -> None:
    if method != "compass":
        pytest.importorskip("scipy")
    found = studies.search_gains(parabola, {"P": (0, 10), "D": (-5, 5)}, method=method, evaluations=300)
    assert found.gains["P"] == pytest.approx(3, abs=0.1) and found.gains["D"] == pytest.approx(-1, abs=0.1)
    assert all(0 <= gains["P"] <= 10 for gains, _ in found.tried)
    edge = studies.search_gains(parabola, {"P": (5, 10), "D": (-5, 5)}, {"P": 9.0}, method="compass")
    assert edge.gains["P"] == 5


def test_a_search_finds_a_faster_axis() -> None:
    program = cc67.compile(SERVO)

    def cost(gains: dict[str, float]) -> float:
        board = cc67.Board(
            programs=[program],
            machine=SERVO.with_suffix(".toml"),
            set={"persist.float.10": gains["P"], "persist.float.12": gains["D"]},
        )
        board.run()
        figures = studies.step_response(board, 0, size=100.0, seconds=0.3).figures
        return figures.settling if figures.settling == figures.settling else 1.0

    found = studies.search_gains(cost, {"P": (0.2, 5), "D": (0, 200)}, evaluations=25)
    assert found.cost < 0.7 * cost({"P": 1.0, "D": 0.0})


def test_wrong_limits_are_refused() -> None:
    with pytest.raises(cc67.InputError, match="limits"):
        studies.search_gains(parabola, {"P": (1, 1)})
    with pytest.raises(cc67.InputError, match="outside"):
        studies.search_gains(parabola, {"P": (0, 1), "D": (0, 1)}, {"P": 2.0})


def test_studies_are_commands_with_pictures(tmp_path: Path) -> None:
    from cc67._command import run

    common = [str(SERVO), "--machine", str(SERVO.with_suffix(".toml")), "--set", "persist.float.10=0.5"]
    picture = tmp_path / "step.svg"
    result = run(["study", "step", *common, "--size", "1000", "-o", str(picture)])
    assert result.returncode == 0, result.stderr
    assert "overshoot  4.3" in result.stdout and picture.read_text().startswith("<svg")
    table = tmp_path / "bode.csv"
    result = run(["study", "frequency", *common, "--size", "1000", "--seconds", "1", "--band", "1:20", "-o", str(table)])
    assert result.returncode == 0, result.stderr
    assert table.read_text().startswith("frequency,magnitude_db,phase_deg\n1,")
    result = run(["study", "following", *common, "--stim", 'at 0.1s command "Move0=500"', "-o", str(tmp_path / "f.csv")])
    assert result.returncode == 0 and result.stdout.startswith("worst ")
    home = [str(HOME), "--machine", str(HOME.with_suffix(".toml")), "--vary", "axis.0.start=-50:50", "--samples", "4"]
    result = run(["study", "tolerance", *home, "--measure", "took=time", "--measure", "homed=persist.20"])
    assert result.returncode == 0 and "homed: min 1, mean 1, max 1" in result.stdout, result.stderr
    result = run(["study", "step", *common, "--axis", "Slid"])
    assert result.returncode == 2 and "did you mean 'Slide'" in result.stderr
