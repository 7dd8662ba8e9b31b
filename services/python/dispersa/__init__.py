"""dispersa: Monte Carlo dispersion campaigns of launch vehicles, from Python.

    import dispersa
    campaign = dispersa.load("campaigns/table3.yaml", cases=200)
    flight = campaign.fly(case=17)
    results = dispersa.run(campaign, "results/trial")
    results.verdict, results.cases["metric_pitch_error_peak_deg"].max()

Flights have the same bits as those of the program `dispersa`. Every name carries its unit.
"""
from . import _processor

_processor.check()

try:
    from ._core import engine_version as _engine_version  # noqa: E402
except ModuleNotFoundError as _error:
    if _error.name != __name__ + "._core":
        raise
    import sys as _sys
    raise ImportError(
        "the extension of dispersa is not built for Python {}.{}; `cmake --build build/release --target python` "
        "builds it, with the packages of docker/packages.txt and tests/packages.txt".format(*_sys.version_info)) from None
from ._source import Tree, read, write  # noqa: E402
from ._campaign import Campaign, Validation, load, validate  # noqa: E402
from .errors import (BadInput, Error, ExitCode, Incomplete, InputWarning, InternalError, Problem,  # noqa: E402
                     ReplayMismatch)
from ._flight import Flight, Flights, History  # noqa: E402
from ._results import (Comparison, Optimization, Results, Tuning, compare, margins, optimize, report, results,  # noqa: E402
                      run, search, sweep, tune, worker_program)

__version__ = _engine_version()
"""The engine's version: results of different ones are never mixed."""


def plan(what, cases=None, **options):
    """Draws the inputs of a campaign's cases, as `dispersa plan` does: `load(what, cases=cases, **options).plan()`, a
    structured array of shape (cases,). Raises BadInput."""
    if isinstance(what, Campaign) and cases is None and not options:
        return what.plan()
    return load(what, cases=cases, **options).plan()


def fly(what, case=None, *, inputs=None, history=True, step_s=0.1, integrator="simpson", law=None, axes=("pitch",),
        **options):
    """Flies one flight: `load(what, **options).fly(case, ...)`, a Flight. Raises BadInput."""
    campaign = what if isinstance(what, Campaign) and not options else load(what, **options)
    return campaign.fly(case, inputs=inputs, history=history, step_s=step_s, integrator=integrator, law=law,
                        axes=axes)


__all__ = ["BadInput", "Campaign", "Comparison", "Error", "ExitCode", "Flight", "Flights", "History", "Incomplete", "InputWarning",
           "InternalError", "Optimization", "Problem", "ReplayMismatch", "Results", "Tree", "Tuning", "Validation", "compare", "fly",
           "load", "margins", "optimize", "plan", "read", "report", "results", "run", "search", "sweep", "tune", "validate", "worker_program",
           "write"]
