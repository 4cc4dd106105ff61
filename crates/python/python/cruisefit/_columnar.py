"""Parquet and Arrow files, decoded by pyarrow: for the native half, which asks for the columns that it wants."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Union

__all__ = ["ENDINGS", "opened", "require_pyarrow"]

ENDINGS = (".parquet", ".arrow", ".arrows", ".feather", ".ipc")

_PARQUET = b"PAR1"
_ARROW_FILE = b"ARROW1"
_ARROW_STREAM = b"\xff" * 4
# Rows that are decoded at a time. Our choice: enough that the work on their ends does not count, few enough for little memory.
_ROWS_AT_ONCE = 1 << 14

Content = Union[Path, bytes]


class Parquet:
    """The rows of a Parquet file."""

    def __init__(self, content: Any) -> None:
        pyarrow = _module("pyarrow")
        # Groups of rows are not read ahead: a group may be most of a file.
        self._file = _module("pyarrow.parquet").ParquetFile(content, pre_buffer=False)
        stored = self._file.schema
        leaves = [stored.column(place) for place in range(len(stored))]
        # Instants of 96 bits are of UTC and do not say so.
        of_96_bits = {leaf.path for leaf in leaves if leaf.physical_type == "INT96"}
        utc = pyarrow.timestamp("ns", "UTC")
        self.schema = pyarrow.schema(
            [field.with_type(utc) if field.name in of_96_bits else field for field in self._file.schema_arrow]
        )

    def batches(self, places: Sequence[int]) -> Iterator[Any]:
        """The columns at these places, some thousand rows at a time."""
        fields = [self.schema.field(place) for place in places]
        names = [field.name for field in fields]
        # A name also stands for the columns that begin with it and a dot: more may come than was asked for.
        for batch in self._file.iter_batches(_ROWS_AT_ONCE, columns=names, use_threads=False):
            columns = [batch.column(batch.schema.get_field_index(field.name)) for field in fields]
            columns = [
                column if column.type == field.type else column.cast(field.type)
                for column, field in zip(columns, fields)
            ]
            yield _module("pyarrow").RecordBatch.from_arrays(columns, names=names)


class Arrow:
    """The rows of an Arrow file (Feather version 2) or stream."""

    def __init__(self, content: Any, is_file: bool) -> None:
        self._content, self._is_file = content, is_file
        self.schema = self._open([]).schema

    def batches(self, places: Sequence[int]) -> Iterator[Any]:
        """The columns at these places, one stored batch at a time."""
        reader = self._open(places)
        if self._is_file:
            yield from (reader.get_batch(number) for number in range(reader.num_record_batches))
        else:
            yield from reader

    def _open(self, places: Sequence[int]) -> Any:
        pyarrow = _module("pyarrow")
        options = pyarrow.ipc.IpcReadOptions(included_fields=list(places), use_threads=False)
        if isinstance(self._content, bytes):
            content = pyarrow.BufferReader(self._content)
        else:
            content = pyarrow.OSFile(str(self._content))
        open_it = pyarrow.ipc.open_file if self._is_file else pyarrow.ipc.open_stream
        return open_it(content, options=options)


def opened(content: Content) -> Parquet | Arrow:
    """A Parquet or Arrow file, or its bytes: ``schema``, and ``batches(places)`` of the columns at these places.

    Raises:
        Exception: Whatever pyarrow raises for a file that it does not read.
    """
    beginning = _beginning(content)
    if beginning.startswith(_PARQUET):
        return Parquet(_module("pyarrow").BufferReader(content) if isinstance(content, bytes) else str(content))
    return Arrow(content, beginning.startswith(_ARROW_FILE))


def require_pyarrow(contents: Iterable[tuple[str, Content]]) -> None:
    """Refuses Parquet and Arrow files, with their names, where pyarrow is not installed.

    Raises:
        ModuleNotFoundError: It is not, and one of these is such a file.
    """
    if importlib.util.find_spec("pyarrow") is not None:
        return
    for name, content in contents:
        if _beginning(content).startswith((_PARQUET, _ARROW_FILE, _ARROW_STREAM)):
            raise ModuleNotFoundError(
                f"{name}: Parquet and Arrow files are read by pyarrow, which is not installed: pip install pyarrow",
                name="pyarrow",
            )


def _beginning(content: Content) -> bytes:
    if isinstance(content, bytes):
        return content[: len(_ARROW_FILE)]
    try:
        with open(content, "rb") as file:
            return file.read(len(_ARROW_FILE))
    except OSError:
        # Whoever reads it says why it cannot be.
        return b""


def _module(name: str) -> Any:
    return importlib.import_module(name)
