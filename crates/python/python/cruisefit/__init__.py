"""Aircraft performance monitoring from cruise reports, over Arrow tables.

The chain of the command line ``cruisefit``, with the same results to the bit:

>>> import cruisefit                                                    # doctest: +SKIP
>>> model = cruisefit.Model.initial("AIRCRAFT.ron", "guide.csv")        # doctest: +SKIP
>>> segments = cruisefit.segment("reports/")                            # doctest: +SKIP
>>> adapted = model.adapt(segments)                                     # doctest: +SKIP
>>> adapted.model("D-ABCD").predict(points)                             # doctest: +SKIP
>>> adapted.model("D-ABCD").diagnose(cruisefit.segment("later/"))       # doctest: +SKIP

Reports are paths (files, folders, globs) or bytes. Tables are anything with the Arrow C interface (pyarrow, polars, pandas,
DuckDB), and results come back in the same library, otherwise in pyarrow. Errors are exceptions of :mod:`cruisefit.errors`.
Calls release the interpreter's lock, use all processors unless told otherwise by ``threads``, give the same bytes for any
number of threads, end at Ctrl-C, and may be made from several threads or after a fork.

On Spark: :mod:`cruisefit.spark`.
"""

from __future__ import annotations

from ._native import __version__
from .adaptation import Adaptation, Evaluation, Monitoring, adapt, evaluate, merge
from .diagnosis import (
    Cause,
    Contribution,
    Diagnosis,
    Gap,
    Magnitude,
    MonthGap,
    Slice,
    TailDiagnosis,
    Verdict,
    diagnose,
    effects,
    explain,
    plot_trials,
)
from .errors import CruisefitError, DataWarning, InputError, InternalError, PredictionWarning
from .model import Model, types
from .segments import PRESETS, Check, Refused, Segments, check, mapping, segment
from .simulation import Simulation, simulate

__all__ = [
    "PRESETS",
    "Adaptation",
    "Cause",
    "Check",
    "Contribution",
    "CruisefitError",
    "DataWarning",
    "Diagnosis",
    "Evaluation",
    "Gap",
    "InputError",
    "InternalError",
    "Magnitude",
    "Model",
    "MonthGap",
    "Monitoring",
    "PredictionWarning",
    "Refused",
    "Segments",
    "Simulation",
    "Slice",
    "TailDiagnosis",
    "Verdict",
    "__version__",
    "adapt",
    "check",
    "diagnose",
    "effects",
    "evaluate",
    "explain",
    "mapping",
    "merge",
    "plot_trials",
    "segment",
    "simulate",
    "types",
]
