"""Tables in and out: whatever has the Arrow C interface, and back to the library that it came from."""

from __future__ import annotations

import importlib
import importlib.util
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from ._native import ArrowStream

__all__ = ["Table", "as_stream", "is_table", "like"]

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
    """A table as the native half takes it; data of pyarrow, polars and DuckDB are not copied.

    Raises:
        TypeError: The value is no table.
    """
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
