// Makes the equations of the book HTML when it is built, so that its pages hold no scripts: a preprocessor of mdbook.
//
//     node docs/equations.js                # reads [context, book] as JSON, writes the book
//     node docs/equations.js supports html
//
// `$$ … $$` is set on its own, `$ … $` in the line; what stands in code is left as it is. KATEX names dist/katex.min.js of the
// package katex, which docs/build.sh fetches; no other package is needed.

"use strict";

const path = require("path");

// Fenced code, code in a line, equations. A backslash before a dollar keeps it, and so does a space after it.
const PIECES = /^(`{3,}|~{3,})[^\n]*\n[\s\S]*?^\1[^\n]*$|(`+)(?:(?!`)[\s\S]|(?!\2)`+)+?\2(?!`)|\\\$|\$\$([\s\S]+?)\$\$|\$(?!\s)((?:\\.|[^$\\\n])+?)(?<![\s\\])\$/gm;
// What Markdown would take for its own in the text of an element.
const SPECIAL = /[\\`*_[\]|~$]/g;

function html(katex, source, displayMode, chapter) {
  let made;
  try {
    made = katex.renderToString(source, { displayMode, output: "htmlAndMathml", throwOnError: true, strict: "ignore" });
  } catch (error) {
    throw new Error(`${chapter}: ${error.message}\n  ${source.trim()}`);
  }
  return made
    .replace(/<annotation[^>]*>[\s\S]*?<\/annotation>/g, "")
    .replace(/\n/g, " ")
    .replace(/>[^<]+</g, (text) => text.replace(SPECIAL, (sign) => `&#${sign.charCodeAt(0)};`));
}

function withEquations(katex, text, chapter) {
  return text.replace(PIECES, (piece, fence, ticks, alone, inLine) => {
    const source = alone ?? inLine;
    return source === undefined ? piece : html(katex, source, alone !== undefined, chapter);
  });
}

function walk(katex, items) {
  for (const { Chapter: chapter } of items) {
    if (chapter === undefined) continue;
    chapter.content = withEquations(katex, chapter.content, chapter.path ?? chapter.name);
    walk(katex, chapter.sub_items);
  }
}

function main() {
  if (process.argv[2] === "supports") return;
  const katex = require(process.env.KATEX ?? path.join(__dirname, "../target/book-tools/katex-0.16.4/dist/katex.min.js"));
  const [, book] = JSON.parse(require("fs").readFileSync(0, "utf8"));
  walk(katex, book.items);
  process.stdout.write(JSON.stringify(book));
}

try {
  main();
} catch (error) {
  console.error(`docs/equations.js: ${error.message}`);
  process.exitCode = 1;
}
