// The numbers behind each chart: a table under it, filled when it is unfolded, and the same as CSV. They are read back from what is
// drawn, so that a page holds them once: places are written to a tenth of a pixel, so that a thousandth of a scale is certain.
(() => {
	'use strict';
	// Rows of a table on the page: more are in the CSV.
	const MOST_ROWS = 200;
	const { all, make, written } = page;

	// What a colour and a mark stand for, by the legend of the chart.
	const lookOf = (path) => [...path.classList].filter((name) => name !== 'small').sort().join(' ');
	const legendOf = (figure) => new Map(all('.legend li', figure).flatMap((entry) =>
		all('path', entry).map((path) => [lookOf(path), entry.textContent.trim()])));
	const seriesOf = (path, legend) => legend.get(lookOf(path)) ?? lookOf(path).replace(/\b(disc|dot|line|area)\b ?/g, '');

	// Places of a path: dots, corners of a line, steps of a histogram with where each begins and ends.
	const placesOf = (path) => {
		if (path.matches('.dot,.disc')) return page.dots(path).map(([x, y]) => [x, x, y]);
		const d = written(path, 'd');
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
		const scales = page.scalesOf(svg);
		const value = (number, length) => number.toFixed(Math.max(0, Math.floor(-Math.log10(length / 1000))));
		const across = (x) => scales.areDates ? page.day(scales.across(x)) : value(scales.across(x), scales.lengths[0]);
		const up = (y) => value(scales.up(y), scales.lengths[1]);
		const legend = legendOf(svg.closest('figure'));
		const paths = all('.marks .dot, .marks .disc, .marks .line, .marks .area', svg);
		// A straight line across or up marks a value of a scale.
		const drawn = paths.map((path) => [path, placesOf(path)]).filter(([path, places]) => places.length > 2 || !path.matches('.line'));
		const steps = drawn.some(([path]) => path.matches('.area'));
		const rows = drawn.flatMap(([path, places]) => places.map(([from, to, y]) =>
			[seriesOf(path, legend), across(from), ...steps ? [across(to)] : [], up(y)]));
		return [['series', scales.acrossName, ...steps ? [`to ${scales.acrossName}`] : [], scales.upName], rows];
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
		button.addEventListener('click', () => page.saveCsv(svg.id || 'chart', [head, ...rows]));
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
