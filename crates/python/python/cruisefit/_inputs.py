"""Which files a call reads: files, folders and patterns. For the same argument they are those that the command line reads
(``crates/cli/src/inputs.rs``)."""

from __future__ import annotations

import os
from pathlib import Path

from . import _native

__all__ = ["Inputs"]


class Inputs:
    """The files that arguments stand for, and what of their folders is none."""

    def __init__(self, endings: tuple[str, ...]) -> None:
        self._endings = endings
        self._searched: set[str] = set()
        self.files: set[Path] = set()
        """Files, each once."""
        self.skipped = 0
        """How many other files the folders have."""
        self.refused: list[tuple[str, int | None, int | None, str]] = []
        """Folders that cannot be listed, with the reason."""

    def add(self, path: Path) -> None:
        """The files of an argument: a file is taken as it is, a folder is searched with all below it, anything else is a pattern
        (``**`` for folders of any depth).

        Raises:
            FileNotFoundError: It matches nothing.
            OSError: It is a folder that cannot be listed.
            InputError: It is no pattern.
        """
        if path.is_dir():
            # A folder that was named has to be there; those below it may be unreadable.
            os.scandir(path).close()
            self._search(path)
            return
        if path.exists():
            self.files.add(path)
            return
        if not any(character in str(path) for character in "*?["):
            raise FileNotFoundError(f"{path}: no such file or folder")
        matches = [Path(match) for match in _native.matches(str(path))]
        if not matches:
            raise FileNotFoundError(f"{path}: the pattern matches no file")
        for match in matches:
            if match.is_dir():
                self._search(match)
            else:
                self.files.add(match)

    def _search(self, folder: Path) -> None:
        try:
            # A link may lead back to a folder above it.
            real = os.path.realpath(folder, strict=True)
            if real in self._searched:
                return
            self._searched.add(real)
            with os.scandir(folder) as entries:
                found = sorted((folder / entry.name, entry.is_dir()) for entry in entries)
        except OSError as error:
            self.refused.append((str(folder), None, None, error.strerror or str(error)))
            return
        for path, is_folder in found:
            if is_folder:
                if not _is_kept_by_a_state(path):
                    self._search(path)
            elif path.suffix.lower() in self._endings:
                self.files.add(path)
            else:
                self.skipped += 1


def _is_kept_by_a_state(folder: Path) -> bool:
    """Whether a folder is one of those in which a folder of ``adapt`` keeps what it has learnt: its tables are no recordings."""
    return folder.name in _native.STATE_FOLDERS and (folder.parent / _native.STATE_NAME).is_file()
