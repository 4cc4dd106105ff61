//! The page's style sheet. Colors are Okabe and Ito's, which people with any color vision can tell apart; shape, dash
//! and words repeat the distinction for print in black and white.

/// The whole sheet.
pub(crate) const STYLE: &str = r#"
:root { color-scheme: light; --before: #d55e00; --after: #0072b2; --ink: #1b1b1b; --soft: #5a5a5a; --line: #c9c9c9; }
html { font-size: 15px; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.2rem 1.4rem 4rem; max-width: 1100px; background: #fff; color: var(--ink);
  font: 1rem/1.45 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; font-variant-numeric: tabular-nums; }
h1 { font-size: 1.55rem; margin: 0 0 .3rem; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; border-bottom: 2px solid var(--ink); padding-bottom: .15rem; }
h3 { font-size: 1.1rem; margin: 0; display: inline; }
h4 { font-size: 1rem; margin: 1.4rem 0 .3rem; }
p { margin: .4rem 0; }
a { color: #00527f; }
code { font-size: .92em; overflow-wrap: anywhere; }
.run { color: var(--soft); }
.note { color: var(--soft); font-size: .87rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .25rem 1rem; margin: .5rem 0; }
dt { font-weight: 600; }
dd { margin: 0; }
table { border-collapse: collapse; font-size: .9rem; }
caption { caption-side: top; text-align: left; color: var(--soft); padding-bottom: .3rem; }
caption b { color: var(--ink); }
th, td { padding: .2rem .55rem; text-align: right; border-bottom: 1px solid var(--line); font-weight: normal; }
thead th { border-bottom: 1.5px solid var(--ink); vertical-align: bottom; font-weight: 600; }
tbody th, tfoot th { text-align: left; font-weight: 600; }
thead tr:first-child th:first-child { text-align: left; }
th[scope=colgroup] { text-align: center; }
.fleet { width: 100%; }
.fleet tbody th { white-space: nowrap; }
@media (max-width: 1000px) { body { padding-inline: .8rem; } .fleet th, .fleet td { padding-inline: .3rem; } }
.fleet tbody tr:hover { background: #f2f6f9; }
.fleet tfoot th, .fleet tfoot td { border-top: 1.5px solid var(--ink); border-bottom: 0; }
.group { border-left: 1px solid var(--line); }
.refused td { text-align: left; }
.refused th { text-align: left; }
.small { margin: .4rem 0 0; }
.row figure { display: inline-block; vertical-align: top; width: min-content; min-width: 27rem; max-width: 100%;
  margin-right: 2rem; }
.scroll { overflow-x: auto; }
.heat { font-size: .82rem; }
.heat td { border: 1px solid var(--line); text-align: center; padding: .15rem .3rem; min-width: 4.6rem; height: 2.1rem; }
.heat td:empty { background: #fafafa; }
.heat thead td:empty { border: 0; background: none; height: auto; }
.heat td span { color: #333; font-size: .9em; white-space: nowrap; }
.heat th, .small th, .small td { white-space: nowrap; }
.less1 { background: #e3f0f8; } .less2 { background: #c6e0f1; } .less3 { background: #a4cde8; }
.less4 { background: #82badf; } .less5 { background: #5ea6d6; }
.more1 { background: #fdf0dc; } .more2 { background: #fbe0b8; } .more3 { background: #f8cd8e; }
.more4 { background: #f4ba63; } .more5 { background: #eda73a; }
details.tail { border: 1px solid var(--line); border-radius: 6px; margin: .5rem 0; }
details.tail > summary { padding: .45rem .8rem; cursor: pointer; background: #f5f6f7; border-radius: 6px; }
details.tail > summary span { color: var(--soft); margin-left: .6rem; }
details.tail > div { padding: .4rem .9rem 1rem; scroll-margin-top: 3rem; }
.figures, .panels { display: grid; grid-template-columns: repeat(auto-fit, minmax(380px, 1fr)); gap: .6rem 1.2rem; }
.panels { grid-template-columns: repeat(auto-fill, minmax(380px, 1fr)); }
figure { margin: 1.1rem 0 0; break-inside: avoid; }
figcaption { font-size: .93rem; max-width: 62rem; }
p.panel { font-weight: 600; font-size: .9rem; margin: .6rem 0 0; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: .1rem 1.1rem; margin: .3rem 0; padding: 0;
  font-size: .85rem; }
.legend li { display: flex; align-items: center; gap: .35rem; }
svg { display: block; width: 100%; height: auto; }
svg.key { width: 26px; height: 12px; flex: none; }
svg text { font-size: 11.5px; fill: var(--ink); font-variant-numeric: tabular-nums; }
svg .label { font-size: 12px; }
svg path { fill: none; }
.grid { stroke: #e6e6e6; stroke-width: 1; }
.frame { stroke: #444; stroke-width: 1; }
.line { stroke-width: 2; }
.line.zero { stroke: #444; stroke-width: 1.2; }
.line.mean { stroke: #444; stroke-width: 1.6; stroke-dasharray: 6 3; }
.line.mean.before { stroke: var(--before); } .line.mean.after { stroke: var(--after); }
.line.initial { stroke: var(--before); stroke-width: 1.4; stroke-dasharray: 5 3; }
.line.final { stroke: var(--after); }
svg .area { stroke-width: 1.4; }
svg .area.before { stroke: var(--before); fill: var(--before); fill-opacity: .14; stroke-dasharray: 4 2; }
svg .area.after { stroke: var(--after); fill: var(--after); fill-opacity: .3; }
.dot, .disc, .core { stroke-linecap: round; }
.dot { stroke-width: 3.2; stroke-opacity: .45; }
.disc { stroke-width: 7; } .core { stroke: #fff; stroke-width: 4; }
.key .dot { stroke-width: 4.5; stroke-opacity: .8; }
.dot.before, .disc.before { stroke: var(--before); }
.dot.after, .disc.after, .disc.final { stroke: var(--after); }
.dot.observed { stroke: #222; }
svg .diamond { fill: #fff; stroke: var(--after); stroke-width: 1.4; }
@media print {
  @page { size: A4; margin: 14mm 12mm; }
  html { font-size: 9pt; }
  body { padding: 0; max-width: none; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  thead { display: table-header-group; }
  tr, li { break-inside: avoid; }
  h2, h4, p.panel, figcaption { break-after: avoid; }
  .scroll { overflow: visible; }
  .figures, .panels { grid-template-columns: 1fr 1fr; }
  .fleet { font-size: 8pt; } .fleet th, .fleet td { padding: .12rem .3rem; }
  .row figure { min-width: 42%; margin-right: 2%; }
  .small { font-size: 7.5pt; } .small th, .small td { padding: .1rem .3rem; }
  svg text, svg .label { font-size: 13px; }
  .heat { font-size: 7pt; } .heat td { min-width: 0; height: auto; padding: .12rem .15rem; }
  details.tail { border: 0; } details.tail[open], .print-all details.tail { break-before: page; }
  .print-all details.tail::details-content { content-visibility: visible; block-size: auto; }
  a { color: inherit; text-decoration: none; }
}
"#;
