// What a page does beyond being read: values under the pointer or the arrow keys, tables that sort, filter and are saved as
// CSV, links that unfold what they lead to, print of everything. Without it the page is complete; it loads nothing.
(() => {
	'use strict';
	const { all, make, written } = page;

	const tip = make('div', '', { id: 'tip', role: 'status' });
	document.body.append(tip);
	const hide = () => { tip.style.display = 'none'; };
	const show = (text, x, y) => {
		tip.textContent = text;
		tip.style.display = 'block';
		const size = tip.getBoundingClientRect();
		tip.style.left = `${Math.max(4, Math.min(x + 12, innerWidth - size.width - 4))}px`;
		tip.style.top = `${y - size.height - 12 < 4 ? y + 16 : y - size.height - 12}px`;
	};

	const points = (svg) => svg.points ??= all('.dot,.disc', svg).flatMap(page.dots).sort((one, other) => one[0] - other[0]);
	const words = (svg, [x, y]) => {
		const scales = page.scalesOf(svg);
		const value = (number) => String(+number.toPrecision(4));
		const across = scales.across(x);
		return `${scales.acrossName}: ${scales.areDates ? page.day(across) : value(across)}\n${scales.upName}: ${value(scales.up(y))}`;
	};
	// Where a place of the whole chart is drawn, which zoom may have moved (`svg.placed`), and whether it is inside the frame.
	// A column has no height: it is told in the middle.
	const frameOf = (svg) => page.numbers(svg.dataset.frame);
	const drawnAt = (svg, [x, y]) => {
		const [, , top, bottom] = frameOf(svg);
		const [across, up] = svg.placed ? svg.placed([x, y]) : [x, y];
		return [across, y === null ? (top + bottom) / 2 : up];
	};
	const isShown = (svg, point) => {
		const [left, right, top, bottom] = frameOf(svg);
		const [x, y] = drawnAt(svg, point);
		return left <= x && x <= right && top <= y && y <= bottom;
	};
	const place = (svg, point) => {
		const [x, y] = drawnAt(svg, point);
		const drawn = svg.getBoundingClientRect();
		const scale = drawn.width / svg.viewBox.baseVal.width;
		return [drawn.left + x * scale, drawn.top + y * scale, scale];
	};
	for (const svg of all('svg[data-frame],svg[data-turn]')) {
		svg.addEventListener('pointermove', (event) => {
			if (svg.dragging) return hide();
			const named = event.target.closest('[data-tip]');
			if (named) return show(named.dataset.tip, event.clientX, event.clientY);
			let best = null;
			let nearest = 14;
			if (svg.dataset.frame) for (const point of points(svg)) {
				const [x, y] = place(svg, point);
				const distance = Math.hypot(x - event.clientX, y - event.clientY);
				if (distance < nearest && isShown(svg, point)) [nearest, best] = [distance, point];
			}
			if (best) show(words(svg, best), event.clientX, event.clientY); else hide();
		});
		svg.addEventListener('pointerleave', hide);
		svg.addEventListener('blur', hide);
		svg.setAttribute('tabindex', '0');
	}
	// What the arrow keys step through: columns that are named (tails, trials), points with their values, else cells (of a map).
	const stopsOf = (svg) => {
		if (svg.stops) return svg.stops;
		const middle = (cell, at, length) => +written(cell, at) + +written(cell, length) / 2;
		const named = (selector, isColumn) => all(selector, svg).map((cell) =>
			({ point: [middle(cell, 'x', 'width'), isColumn ? null : middle(cell, 'y', 'height')], told: cell.dataset.tip }));
		const found = [named('.hit[data-tip]', true), points(svg).map((point) => ({ point, told: words(svg, point) })), named('.cell[data-tip]', false)];
		svg.stops = found.find((stops) => stops.length) ?? [];
		return svg.stops;
	};
	const step = (svg, by) => {
		const stops = stopsOf(svg);
		const shown = stops.filter((stop) => isShown(svg, stop.point));
		const next = shown.indexOf(svg.stop) + by;
		// From outside the part that is shown the keys lead to its first or last one.
		svg.stop = shown.includes(svg.stop) ? shown[next] ?? svg.stop : shown.at(by > 0 ? 0 : -1);
		tellStop(svg);
	};
	const tellStop = (svg) => {
		if (!svg.stop || !isShown(svg, svg.stop.point)) return hide();
		show(svg.stop.told, ...place(svg, svg.stop.point));
	};
	for (const svg of all('svg[data-frame]')) {
		svg.addEventListener('keydown', (event) => {
			const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
			if (!by || event.shiftKey) return;
			event.preventDefault();
			step(svg, by);
		});
		svg.addEventListener('zoomed', () => { if (document.activeElement === svg) tellStop(svg); else hide(); });
	}
	for (const element of all('[data-tip]:not(svg *)')) {
		element.addEventListener('pointermove', (event) => show(element.dataset.tip, event.clientX, event.clientY));
		element.addEventListener('pointerleave', hide);
	}
	document.addEventListener('keydown', (event) => { if (event.key === 'Escape') hide(); });

	const text = (cell) => cell.innerText.trim();
	const key = (cell) => cell.dataset.v === undefined ? text(cell) : +cell.dataset.v;
	for (const table of all('table.sort')) {
		const heads = all('thead th', table);
		heads.forEach((head, column) => {
			const button = make('button', '', { type: 'button' });
			button.append(...head.childNodes);
			head.append(button);
			button.addEventListener('click', () => {
				const falling = head.getAttribute('aria-sort') === 'descending' ? 1 : -1;
				heads.forEach((other) => other.removeAttribute('aria-sort'));
				head.setAttribute('aria-sort', falling < 0 ? 'descending' : 'ascending');
				const order = (one, other) => {
					const [a, b] = [key(one.cells[column]), key(other.cells[column])];
					return falling * (typeof a === 'number' && typeof b === 'number' ? a - b : String(a).localeCompare(String(b)));
				};
				table.tBodies[0].append(...[...table.tBodies[0].rows].sort(order));
			});
		});
		if (table.tBodies[0].rows.length < 6) continue;
		const filter = make('input', '', { type: 'search', placeholder: 'filter tails', 'aria-label': 'filter the rows of this table' });
		filter.addEventListener('input', () => {
			for (const row of table.tBodies[0].rows) row.hidden = !text(row).toLowerCase().includes(filter.value.toLowerCase());
		});
		(table.closest('.scroll') ?? table).before(filter);
	}

	for (const table of all('table.data')) {
		const save = make('button', 'Save as CSV', { type: 'button', class: 'save' });
		save.addEventListener('click', () => {
			// Drawings are not numbers; a heading over a drawing and its number is that of the number.
			const fields = (cell) => [text(cell).replace(/\s+/g, ' '), ...Array(cell.matches('td') ? cell.colSpan - 1 : 0).fill('')];
			const rows = [...table.rows].map((row) => [...row.cells].filter((cell) => !cell.matches('.bar,.drawn')).flatMap(fields));
			page.saveCsv(table.dataset.name ?? 'table', rows);
		});
		(table.closest('.scroll') ?? table).after(save);
	}

	const unfold = () => {
		const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
		for (let fold = target?.closest('details'); fold; fold = fold.parentElement.closest('details')) fold.open = true;
		target?.scrollIntoView();
	};
	addEventListener('hashchange', unfold);
	if (location.hash) unfold();

	let folded = [];
	addEventListener('beforeprint', () => {
		folded = all('details:not([open]):not(.values)');
		for (const fold of folded) fold.open = true;
	});
	addEventListener('afterprint', () => { for (const fold of folded) fold.open = false; });
})();
