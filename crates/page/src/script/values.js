// The numbers behind each chart: a table under it, filled when it is unfolded, and the same as CSV. They are read back from what is
// drawn, so that a page holds them once: places are written to a tenth of a pixel, so that a thousandth of a scale is certain.
(() => {
  'use strict';
  // Rows of a table on the page: more are in the CSV.
  const MOST_ROWS = 200;
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const make = (name, text, attributes = {}) => {
    const made = Object.assign(document.createElement(name), { textContent: text });
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };
  const written = (element) => element.written?.d ?? element.getAttribute('d');
  const numbers = (text) => text.split(' ').map(Number);

  // What a colour and a mark stand for, by the legend of the chart.
  const seriesOf = (path, entries) => {
    const own = [...path.classList].filter((name) => name !== 'small').sort().join(' ');
    return entries.find(([classes]) => classes === own)?.[1] ?? own.replace(/\b(disc|dot|line|area)\b ?/g, '');
  };
  const legendOf = (figure) => all('.legend li', figure ?? document.createElement('i')).flatMap((entry) =>
    all('path', entry).map((path) => [[...path.classList].filter((name) => name !== 'small').sort().join(' '), entry.textContent.trim()]));

  // Places of a path: dots, corners of a line, steps of a histogram with where each begins and ends.
  const placesOf = (path) => {
    const d = written(path);
    if (path.matches('.dot,.disc')) return [...d.matchAll(/M([-\d.]+) ([-\d.]+)h0/g)].map(([, x, y]) => [+x, +x, +y]);
    if (path.matches('.line')) return [...d.matchAll(/[ML]([-\d.]+) ([-\d.]+)/g)].map(([, x, y]) => [+x, +x, +y]);
    let from = +d.match(/^M([-\d.]+)/)?.[1];
    return [...d.matchAll(/V([-\d.]+)H([-\d.]+)/g)].map(([, y, to]) => {
      const place = [from, +to, +y];
      from = +to;
      return place;
    });
  };

  // Heading and rows: what cells and columns are told to hold, else the points of every series.
  const rowsOf = (svg) => {
    const told = all('[data-tip]', svg).map((cell) => cell.dataset.tip.split('\n'));
    if (told.length) {
      const most = Math.max(...told.map((lines) => lines.length));
      return [['where', ...Array(most - 1).fill('what')], told.map((lines) => [...lines, ...Array(most - lines.length).fill('')])];
    }
    const [left, right, top, bottom] = numbers(svg.dataset.frame);
    const [[x0, x1], [y0, y1]] = [numbers(svg.dataset.x), numbers(svg.dataset.y)];
    const value = (number, range) => number.toFixed(Math.max(0, Math.floor(-Math.log10(range / 1000))));
    const across = (x) => {
      const at = x0 + (x - left) / (right - left) * (x1 - x0);
      return svg.dataset.xOf === 'dates' ? new Date(at * 1000).toISOString().slice(0, 10) : value(at, x1 - x0);
    };
    const up = (y) => value(y0 + (bottom - y) / (bottom - top) * (y1 - y0), y1 - y0);
    const [acrossName, upName] = all('.label', svg).map((label) => label.textContent);
    const entries = legendOf(svg.closest('figure'));
    const paths = all('.marks .dot, .marks .disc, .marks .line, .marks .area', svg);
    // A straight line across or up marks a value of a scale.
    const drawn = paths.map((path) => [path, placesOf(path)]).filter(([path, places]) => places.length > 2 || !path.matches('.line'));
    const steps = drawn.some(([path]) => path.matches('.area'));
    const rows = drawn.flatMap(([path, places]) => places.map(([from, to, y]) =>
      [seriesOf(path, entries), across(from), ...steps ? [across(to)] : [], up(y)]));
    return [['series', acrossName, ...steps ? [`to ${acrossName}`] : [], upName], rows];
  };

  // A field that a spreadsheet would take for a formula gets a quote in front; numbers keep their sign.
  const field = (value) => `"${(/^[=+\-@\t]/.test(value) && !Number.isFinite(Number(value.replace(/[ %]+$/, ''))) ? "'" : '') + value.replaceAll('"', '""')}"`;
  const save = (svg) => {
    const [head, rows] = rowsOf(svg);
    const link = make('a', '', { download: `${svg.id || 'chart'}.csv` });
    link.href = URL.createObjectURL(new Blob([`${[head, ...rows].map((row) => row.map(field).join(',')).join('\r\n')}\r\n`], { type: 'text/csv' }));
    link.click();
    URL.revokeObjectURL(link.href);
  };
  const fill = (fold, svg, name) => {
    const [head, rows] = rowsOf(svg);
    const table = make('table', '');
    const heading = table.createTHead().insertRow();
    for (const words of head) heading.append(make('th', words, { scope: 'col' }));
    const body = table.createTBody();
    for (const row of rows.slice(0, MOST_ROWS)) {
      const line = body.insertRow();
      for (const words of row) line.append(make('td', words));
    }
    const scroll = make('div', '', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': `Values: ${name}` });
    scroll.append(table);
    fold.append(scroll);
    if (rows.length > MOST_ROWS) fold.append(make('p', `${rows.length - MOST_ROWS} more rows are in the CSV.`, { class: 'note' }));
    const button = make('button', 'Save as CSV', { type: 'button', class: 'save' });
    button.addEventListener('click', () => save(svg));
    fold.append(button);
  };
  for (const svg of all('figure svg[data-frame]')) {
    const fold = make('details', '', { class: 'values' });
    const name = svg.querySelector('title')?.textContent ?? 'chart';
    fold.append(make('summary', 'Values'));
    fold.addEventListener('toggle', () => { if (fold.open && fold.childElementCount === 1) fill(fold, svg, name); });
    svg.closest('figure').append(fold);
  }
})();
