"""Common studies of motion controllers, as functions.

    from cc67 import studies

    response = studies.step_response(board, axis=0, size=400)
    response.figures.overshoot                      # 0.16 is 16 %
    studies.frequency_response(board, axis=0, frequencies=[1, 10, 100]).magnitude_db
    studies.tolerance("home.c", {"axis.0.start": (-50, 50)}, measure, samples=200)
    studies.search_gains(cost, {"P": (0.1, 2), "D": (0, 50)})
    studies.following_error(board, axis=0, seconds=2.0)

The board itself makes and records steps, with the script commands GatherStep and GetGather.
"""

from ._following import FollowingError, following_error, worst_following_error
from ._gains import GainSearch, search_gains
from ._response import (
    FrequencyResponse,
    StepFigures,
    StepResponse,
    frequency_response,
    step_figures,
    step_response,
)
from ._tolerance import Tolerance, normal, tolerance, uniform

__all__ = [
    "FollowingError",
    "FrequencyResponse",
    "GainSearch",
    "StepFigures",
    "StepResponse",
    "Tolerance",
    "following_error",
    "frequency_response",
    "normal",
    "search_gains",
    "step_figures",
    "step_response",
    "tolerance",
    "uniform",
    "worst_following_error",
]
