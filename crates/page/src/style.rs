//! The page's style sheet. Colors are Okabe and Ito's, which people with any color vision can tell apart; shape, dash
//! and words repeat the distinction for print in black and white.

/// The whole sheet.
pub(crate) const STYLE: &str = r#"
:root { color-scheme: light; --before: #d55e00; --after: #0072b2; --ink: #1b1b1b; --soft: #5a5a5a; --line: #c9c9c9;
  --paper: #fff; --card: #f5f6f7; --rule: #e6e6e6; --strong: #444; --link: #00527f; --shade-ink: #1b1b1b; }
@media screen and (prefers-color-scheme: dark) {
  :root { color-scheme: dark; --before: #f0883e; --after: #58b0ec; --ink: #e8e8e8; --soft: #a8adb2; --line: #44494f;
    --paper: #15181b; --card: #1f2428; --rule: #2b3036; --strong: #9aa0a6; --link: #8cc8f2; }
}
html { font-size: 15px; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.2rem 1.4rem 4rem; max-width: 1180px; background: var(--paper); color: var(--ink);
  font: 1rem/1.45 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; font-variant-numeric: tabular-nums; }
h1 { font-size: 1.55rem; margin: 0 0 .3rem; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; border-bottom: 2px solid var(--ink); padding-bottom: .15rem; }
h3 { font-size: 1.1rem; margin: 0; display: inline; }
h4 { font-size: 1rem; margin: 1.4rem 0 .3rem; }
p { margin: .4rem 0; }
a { color: var(--link); }
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
.fleet { width: 100%; } .fleet th, .fleet td { padding-inline: .3rem; }
.fleet tbody th, .fleet tbody td { white-space: nowrap; }
.fleet tbody td.words { white-space: normal; text-align: left; min-width: 14rem; }
@media (max-width: 1000px) { body { padding-inline: .8rem; } }
.fleet tbody tr:hover { background: var(--card); }
.fleet tfoot th, .fleet tfoot td { border-top: 1.5px solid var(--ink); border-bottom: 0; }
.group { border-left: 1px solid var(--line); }
.refused td { text-align: left; }
.refused th { text-align: left; }
.small { margin: .4rem 0 0; }
.row { display: flex; flex-wrap: wrap; gap: 0 2rem; }
.row figure { max-width: 100%; min-width: 0; }
.row figcaption { max-width: 34rem; }
.scroll { overflow-x: auto;
  background: linear-gradient(to right, var(--paper) 40%, transparent) 0 0, linear-gradient(to left, var(--paper) 40%, transparent) 100% 0,
    linear-gradient(to right, var(--line), transparent) 0 0, linear-gradient(to left, var(--line), transparent) 100% 0;
  background-repeat: no-repeat; background-size: 3rem 100%, 3rem 100%, .8rem 100%, .8rem 100%; background-attachment: local, local, scroll, scroll; }
.heat { font-size: .82rem; }
.heat td { border: 1px solid var(--line); text-align: center; padding: .15rem .3rem; min-width: 4.6rem; height: 2.1rem; }
.heat td:empty { background: var(--card); }
.heat thead td:empty { border: 0; background: none; height: auto; }
.heat td span { color: inherit; font-size: .9em; white-space: nowrap; }
.heat th, .small th, .small td { white-space: nowrap; }
.less1 { background: #e3f0f8; } .less2 { background: #c6e0f1; } .less3 { background: #a4cde8; }
.less4 { background: #82badf; } .less5 { background: #5ea6d6; }
.more1 { background: #fdf0dc; } .more2 { background: #fbe0b8; } .more3 { background: #f8cd8e; }
.more4 { background: #f4ba63; } .more5 { background: #eda73a; }
.heat td[class^=less], .heat td[class^=more] { color: var(--shade-ink); }
@media screen and (prefers-color-scheme: dark) {
  .less1 { background: #1a2f3d; } .less2 { background: #1f465c; } .less3 { background: #285a73; } .less4 { background: #2b6c90; } .less5 { background: #58b0ec; }
  .more1 { background: #3a2a1c; } .more2 { background: #5d3d20; } .more3 { background: #784820; } .more4 { background: #935420; } .more5 { background: #f0883e; }
  .heat td[class^=less]:not(.less5), .heat td[class^=more]:not(.more5) { color: var(--ink); }
}
svg .cell { stroke: var(--paper); stroke-width: 1; fill: var(--card); }
svg .less1 { fill: #d3e7f4; } svg .less2 { fill: #a9cfe9; } svg .less3 { fill: #75b1da; } svg .less4 { fill: #3f8fc5; } svg .less5 { fill: #0072b2; }
svg .more1 { fill: #fbe3cb; } svg .more2 { fill: #f7c493; } svg .more3 { fill: #f0a05a; } svg .more4 { fill: #e57d28; } svg .more5 { fill: #d55e00; }
svg .even { fill: #e4e4e4; }
@media screen and (prefers-color-scheme: dark) {
  svg .less1 { fill: #1a2f3d; } svg .less2 { fill: #1f465c; } svg .less3 { fill: #28637f; } svg .less4 { fill: #3787b3; } svg .less5 { fill: #58b0ec; }
  svg .more1 { fill: #3a2a1c; } svg .more2 { fill: #5d3d20; } svg .more3 { fill: #8c5524; } svg .more4 { fill: #bd6d2a; } svg .more5 { fill: #f0883e; }
  svg .even { fill: #2b3036; }
}
svg .cell.hit { fill: transparent; stroke: none; } svg .cell.hit:hover { fill: var(--soft); fill-opacity: .15; }
svg .cell.faint { fill-opacity: .35; }
.disc.small { stroke-width: 5; }
.line.thin { stroke-width: 1; }
svg .within { stroke: var(--ink); stroke-width: 2.2; }
.verdict { background: var(--card); border-left: 5px solid var(--after); border-radius: 4px; padding: .5rem 1rem; margin: .6rem 0; }
.verdict.gap { border-left-color: var(--before); }
.verdict dd { max-width: 58rem; }
.bars { width: 100%; }
.bars th, .bars td { text-align: left; vertical-align: top; }
.bars thead th { vertical-align: bottom; }
.bars td.bar { width: 34%; min-width: 6rem; vertical-align: middle; }
.bar span { display: block; height: .9rem; background: var(--after); border-radius: 2px; min-width: 1px; }
.bar span.thin { height: .3rem; margin-top: 2px; }
.bar .fall { display: flex; } .bar span.taken { background: var(--before); opacity: .28; }
.bar span.before { background: var(--before); } .bar span.noise { background: var(--soft); }
.bars td.number { white-space: nowrap; width: 4.5rem; } .bars td .id { white-space: nowrap; }
.bars th:last-child { min-width: 6.5rem; }
.bars code, .id { color: var(--soft); font-size: .82em; }
details.more { margin: .8rem 0; }
details.values { font-size: .82rem; } details.values > summary { cursor: pointer; color: var(--link); }
details.values .scroll { max-height: 18rem; overflow-y: auto; } details.values td, details.values th { padding: .1rem .6rem .1rem 0; text-align: left; }
details.more > summary { cursor: pointer; color: var(--link); }
details.more > summary:focus-visible, details.values > summary:focus-visible, details.tail > summary:focus-visible, a:focus-visible, button:focus-visible, svg:focus-visible
  { outline: 2px solid var(--after); outline-offset: 2px; }
th button { font: inherit; color: inherit; background: none; border: 0; padding: 0; cursor: pointer; text-align: inherit; }
th button::after { content: "\00a0↕"; color: var(--soft); font-weight: normal; }
th[aria-sort=ascending] button::after { content: "\00a0↑"; } th[aria-sort=descending] button::after { content: "\00a0↓"; }
input[type=search] { font: inherit; padding: .25rem .5rem; margin: .3rem 0; max-width: 100%; color: var(--ink); background: var(--paper);
  border: 1px solid var(--soft); border-radius: 4px; }
button.save { font: inherit; font-size: .82rem; color: var(--link); background: none; border: 1px solid var(--line); border-radius: 4px;
  padding: .1rem .5rem; margin: .3rem 0; cursor: pointer; }
svg:focus:not(:focus-visible) { outline: none; }
svg[data-frame] { cursor: crosshair; user-select: none; -webkit-user-select: none; }
svg[data-turn] { cursor: grab; touch-action: pan-y; user-select: none; -webkit-user-select: none; }
svg .facet { stroke: var(--soft); stroke-width: .6; stroke-linejoin: round; } .line.within { stroke: var(--ink); stroke-width: 1.3; }
svg .margin { fill: var(--paper); } svg .chosen { fill: var(--after); fill-opacity: .15; stroke: var(--after); }
.zoom { color: var(--soft); font-size: .78rem; margin: 0 0 .3rem 2rem; }
.zoom button { font: inherit; color: var(--link); background: none; border: 1px solid var(--line); border-radius: 4px; padding: .05rem .45rem;
  cursor: pointer; }
.zoom button[aria-pressed=true] { border-color: var(--after); background: var(--card); }
#tip { display: none; position: fixed; z-index: 9; max-width: 22rem; padding: .3rem .55rem; white-space: pre-line; pointer-events: none;
  background: var(--ink); color: var(--paper); border-radius: 4px; font-size: .85rem; }
svg .span { stroke: var(--soft); stroke-width: 1.2; }
svg .interval { stroke: var(--before); stroke-width: 1.6; }
svg .event { stroke: var(--ink); stroke-width: 1.4; stroke-dasharray: 2 3; }
.spark { width: 9rem; min-width: 9rem; height: 14px; }
details.tail { border: 1px solid var(--line); border-radius: 6px; margin: .5rem 0; }
details.tail > summary { padding: .45rem .8rem; cursor: pointer; background: var(--card); border-radius: 6px; }
details.tail > summary span { color: var(--soft); margin-left: .6rem; }
details.tail > div { padding: .4rem .9rem 1rem; scroll-margin-top: 3rem; }
.figures, .panels { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(380px, 100%), 1fr)); gap: .6rem 1.2rem; }
.panels { grid-template-columns: repeat(auto-fill, minmax(min(380px, 100%), 1fr)); }
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
.grid { stroke: var(--rule); stroke-width: 1; }
.frame { stroke: var(--strong); stroke-width: 1; }
.line { stroke-width: 2; }
.line.zero { stroke: var(--strong); stroke-width: 1.2; }
.line.mean { stroke: var(--strong); stroke-width: 1.6; stroke-dasharray: 6 3; }
.line.mean.before { stroke: var(--before); } .line.mean.after { stroke: var(--after); }
.line.initial { stroke: var(--before); stroke-width: 1.4; stroke-dasharray: 5 3; }
.line.final { stroke: var(--after); }
svg .area { stroke-width: 1.4; }
svg .area.before { stroke: var(--before); fill: var(--before); fill-opacity: .14; stroke-dasharray: 4 2; }
svg .area.after { stroke: var(--after); fill: var(--after); fill-opacity: .3; }
.dot, .disc, .core { stroke-linecap: round; }
.dot { stroke-width: 3.2; stroke-opacity: .45; }
.disc { stroke-width: 7; } .core { stroke: var(--paper); stroke-width: 4; }
.key .dot { stroke-width: 4.5; stroke-opacity: .8; }
.dot.before, .disc.before { stroke: var(--before); }
.dot.after, .disc.after, .disc.final { stroke: var(--after); }
.dot.observed { stroke: var(--ink); }
svg .diamond { fill: var(--paper); stroke: var(--after); stroke-width: 1.4; }
@media (max-width: 640px) {
  html { font-size: 14px; }
  body { padding-inline: .7rem; }
  dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: .45rem; }
  svg text, svg .label { font-size: 12.5px; }
  .wide .scroll > svg { min-width: 640px; }
  .bars td.bar { width: 22%; min-width: 3.5rem; }
  details.tail > div { padding-inline: .5rem; }
}
@media print {
  @page { size: A4; margin: 14mm 12mm; }
  html { font-size: 9pt; }
  body { padding: 0; max-width: none; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  thead { display: table-header-group; }
  tr, li { break-inside: avoid; }
  h2, h4, p.panel, figcaption { break-after: avoid; }
  .scroll { overflow: visible; background: none; }
  .drawn { display: none; }
  .figures, .panels { grid-template-columns: 1fr 1fr; }
  .fleet { font-size: 8pt; } .fleet th, .fleet td { padding: .12rem .3rem; }
  .row figure { min-width: 42%; margin-right: 2%; }
  .small { font-size: 7.5pt; } .small th, .small td { padding: .1rem .3rem; }
  svg text, svg .label { font-size: 13px; }
  .heat { font-size: 7pt; } .heat td { min-width: 0; height: auto; padding: .12rem .15rem; }
  details.tail { border: 0; } details.tail + details.tail { break-before: page; }
  details::details-content { content-visibility: visible; block-size: auto; }
  input, button.save, .zoom, .values, #tip { display: none !important; }
  th button::after { content: ""; }
  .verdict, .bars tr { break-inside: avoid; }
  a { color: inherit; text-decoration: none; }
}
"#;
