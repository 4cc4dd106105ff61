// What the scripts of a page share: finding and making elements, reading a chart back, saving a table.
const page = (() => {
	'use strict';
	const all = (selector, root = document) => [...root.querySelectorAll(selector)];
	const make = (name, text, attributes = {}) => {
		const made = Object.assign(document.createElement(name), { textContent: text });
		for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
		return made;
	};
	const numbers = (text) => text.split(' ').map(Number);

	// The points of a chart are read back from its paths: "M64 108h0" is a dot, the frame and the scales are attributes.
	// A zoom moves them and leaves what was written beside it.
	const written = (element, name) => element.written?.[name] ?? element.getAttribute(name);
	const dots = (path) => [...written(path, 'd').matchAll(/M([-\d.]+) ([-\d.]+)h0/g)].map(([, x, y]) => [+x, +y]);

	// Names and values of a chart's scales at places of its drawing.
	const scalesOf = (svg) => {
		const [left, right, top, bottom] = numbers(svg.dataset.frame);
		const [[x0, x1], [y0, y1]] = [numbers(svg.dataset.x), numbers(svg.dataset.y)];
		const [acrossName, upName] = all('.label', svg).map((label) => label.textContent);
		return {
			acrossName,
			upName,
			areDates: svg.dataset.xOf === 'dates',
			lengths: [x1 - x0, y1 - y0],
			across: (x) => x0 + (x - left) / (right - left) * (x1 - x0),
			up: (y) => y0 + (bottom - y) / (bottom - top) * (y1 - y0),
		};
	};
	const day = (at_s) => new Date(at_s * 1000).toISOString().slice(0, 10);

	// A field that a spreadsheet would take for a formula gets a quote in front; numbers keep their sign.
	const field = (value) => `"${(/^[=+\-@\t]/.test(value) && !Number.isFinite(Number(value.replace(/[ %]+$/, ''))) ? "'" : '') + value.replaceAll('"', '""')}"`;
	const saveCsv = (name, rows) => {
		const link = make('a', '', { download: `${name}.csv` });
		const lines = rows.map((row) => row.map(field).join(','));
		link.href = URL.createObjectURL(new Blob([`${lines.join('\r\n')}\r\n`], { type: 'text/csv' }));
		link.click();
		URL.revokeObjectURL(link.href);
	};

	return { all, make, numbers, written, dots, scalesOf, day, saveCsv };
})();
