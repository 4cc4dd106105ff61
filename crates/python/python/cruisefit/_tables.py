"""Tables in and out: whatever has the Arrow C interface, and back to the library that it came from."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from typing import TYPE_CHECKING, Any, cast

from . import _native

if TYPE_CHECKING:
    from ._native import ArrowStream

__all__ = ["Table", "as_points", "as_stream", "is_frame", "is_table", "like", "with_prediction"]

# A table of pyarrow, polars, pandas, DuckDB or any other library; none of them is required to be installed.
Table = Any


def is_table(value: object) -> bool:
    """Whether a value is a table: it has the Arrow C interface, or is a mapping of columns."""
    return (
        hasattr(value, "__arrow_c_stream__")
        or hasattr(value, "__arrow_c_array__")
        or hasattr(value, "to_arrow_table")
        or isinstance(value, dict)
    )


def as_stream(value: Table) -> ArrowStream:
    """A table as the native half takes it; data of pyarrow, polars and DuckDB are not copied. Of the index of a pandas frame,
    levels that have a name are columns: a time often is.

    Raises:
        TypeError: The value is no table.
    """
    if _is_frame_of(value, "pandas"):
        known = [None, *value.columns]
        levels = [level for level, name in enumerate(value.index.names) if name not in known]
        return _without_index(value.reset_index(levels) if levels else value)
    if _is_frame_of(value, "polars"):
        return _of_polars(value)
    if isinstance(value, dict):
        return cast("ArrowStream", _module("pyarrow").table(value))
    if hasattr(value, "__arrow_c_stream__") or hasattr(value, "__arrow_c_array__"):
        return cast("ArrowStream", value)
    if hasattr(value, "to_arrow_table"):  # a relation of DuckDB before 1.3
        return cast("ArrowStream", value.to_arrow_table())
    collect = "; collect() it first" if hasattr(value, "collect") else ""
    raise TypeError(
        f"found {type(value).__name__}, expected a table with the Arrow C interface "
        f"(pyarrow, polars, pandas 2.2 or later, DuckDB){collect}"
    )


def is_frame(value: Table) -> bool:
    """Whether a table is a frame of pandas or polars, to which a result adds its columns."""
    return _is_frame_of(value, "pandas") or _is_frame_of(value, "polars")


def as_points(value: Table) -> ArrowStream:
    """Flight points as the native half takes them: of a frame, which is kept aside, neither its index nor its columns whose
    names begin with ``X-``, which have no meaning and may be of any type.

    Raises:
        TypeError: The value is no table.
    """
    if not is_frame(value):
        return as_stream(value)
    places = [place for place, name in enumerate(value.columns) if not str(name).startswith("X-")]
    if _is_frame_of(value, "pandas"):
        return _without_index(value.iloc[:, places])
    return _of_polars(value[:, places])


def with_prediction(frame: Table, added: ArrowStream) -> Table:
    """A frame with the columns of a prediction, in its own library: its own columns keep their types and, of pandas, it keeps
    its index. Those of an earlier prediction are left out, as in a table of any other library: beside the new ones they would
    be read as of the same model."""
    of_flights = [str(name).strip() not in _native.PREDICTED_COLUMNS for name in frame.columns]
    if _is_frame_of(frame, "polars"):
        kept = frame[:, [place for place, keep in enumerate(of_flights) if keep]]
        return kept.hstack(_module("polars").DataFrame(added))
    columns = _module("pyarrow").table(added).to_pandas()
    if not all(of_flights):
        frame = frame.loc[:, of_flights]
    # As arrays: their rows are those of the frame, whatever its index calls them.
    return frame.assign(**{name: columns[name].to_numpy() for name in columns.columns})


def _is_frame_of(value: object, library: str) -> bool:
    """Whether a value is a frame of a library; one that was not imported has made none."""
    module = sys.modules.get(library)
    return module is not None and isinstance(value, module.DataFrame)


def _of_polars(frame: Table) -> ArrowStream:
    """A frame whose types the Arrow C interface has: what polars passes on for some is of its own."""
    polars = _module("polars")
    of_its_own = [getattr(polars, name, None) for name in ("Null", "Int128", "UInt128")]
    found = [kind for kind in of_its_own if kind is not None and kind in frame.dtypes]
    if found:
        frame = frame.cast({kind: polars.Float64 for kind in found})
    return cast("ArrowStream", frame)


def _without_index(frame: Table) -> ArrowStream:
    return cast("ArrowStream", _module("pyarrow").Table.from_pandas(frame, preserve_index=False))


def like(stream: ArrowStream, given: object = None) -> Table:
    """A result in the library that ``given`` is of; otherwise in pyarrow, and without pyarrow as it is: an object with the
    Arrow C interface."""
    library = type(given).__module__.partition(".")[0]
    if library == "polars":
        return _module("polars").DataFrame(stream)
    if library == "pandas":
        return _module("pyarrow").table(stream).to_pandas()
    if importlib.util.find_spec("pyarrow") is None:
        return stream
    return _module("pyarrow").table(stream)


def _module(name: str) -> Any:
    return importlib.import_module(name)
