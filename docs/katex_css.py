#!/usr/bin/env python3
"""Writes one stylesheet for the equations of the book, fonts included, so that the book is read without a network.

    npm pack katex@0.16.4 && python3 docs/katex_css.py katex-0.16.4.tgz docs/katex.css

Fonts that no page uses (Caligraphic, Fraktur, SansSerif, Script, Typewriter) are left out. Standard library only.
"""

import base64
import re
import sys
import tarfile

USED = re.compile(r"KaTeX_(AMS|Main|Math|Size\d)")


def main():
    package, target = sys.argv[1:]
    with tarfile.open(package) as files:
        read = lambda name: files.extractfile("package/dist/" + name).read()
        style = read("katex.min.css").decode()

        def face(rule):
            font = re.search(r"url\((fonts/[^)]*\.woff2)\)", rule[0])[1]
            if not USED.search(font):
                return ""
            data = base64.b64encode(read(font)).decode()
            source = f'src:url(data:font/woff2;base64,{data}) format("woff2")'
            return re.sub(r"src:[^}]*", lambda _: source, rule[0])

        style = re.sub(r"@font-face\{[^}]*\}", face, style)
    version = re.search(r"katex-([\d.]+)\.tgz$", package)[1]
    license_line = f"/* KaTeX {version}, https://katex.org, MIT license. Made by docs/katex_css.py. */\n"
    with open(target, "w", encoding="utf-8") as output:
        output.write(license_line + style)


main()
