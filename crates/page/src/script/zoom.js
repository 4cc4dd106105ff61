// Zoom of charts with scales. What is drawn is moved and the scales are drawn anew, so that lines and points keep their size; a chart
// remembers how it was written, and is printed like that.
(() => {
	'use strict';
	const DAY_S = 86400;
	// Places are written to a tenth of a pixel: enlarged more than this, the tenths would show.
	const DEEPEST = 32;
	// Pixels: a shorter drag is a click, a flat one chooses along one scale.
	const SHORTEST = 5;
	const { all, numbers } = page;
	const tenth = (number) => String(Math.round(number * 10) / 10);

	const roundTicks = (low, high, most, leastStep) => {
		const power = 10 ** Math.floor(Math.log10((high - low) / most));
		const digit = [1, 2, 5, 10].find((one) => one * power * most >= (high - low) * (1 - 1e-9));
		const step = Math.max(leastStep, digit * power);
		const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
		const ticks = [];
		for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) ticks.push([k * step, (k * step).toFixed(decimals)]);
		return ticks;
	};
	const dateTicks = (low, high, most) => {
		const text = (at_s) => new Date(at_s * 1000).toISOString();
		for (const step of [600, 1800, 3600, 10800, 21600, 43200, ...[1, 2, 5, 10].map((days) => days * DAY_S)]) {
			const [first, last] = [Math.ceil(low / step), Math.floor(high / step)];
			if (last - first >= most) continue;
			const label = (at_s) => step < DAY_S ? text(at_s).slice(5, 16).replace('T', ' ') : text(at_s).slice(0, 10);
			return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => [(first + k) * step, label((first + k) * step)]);
		}
		const begin = new Date(low * 1000);
		for (const months of [1, 2, 3, 6, 12, 24, 60, 120, 240, 600, 12000]) {
			const ticks = [];
			for (let month = Math.floor((begin.getUTCFullYear() * 12 + begin.getUTCMonth()) / months) * months; ; month += months) {
				const at_s = Date.UTC(Math.floor(month / 12), month % 12) / 1000;
				if (!(at_s <= high)) break;
				if (at_s >= low) ticks.push([at_s, text(at_s).slice(0, 10)]);
			}
			if (ticks.length <= most) return ticks;
		}
		return [];
	};

	const KEPT = ['d', 'x', 'y', 'width', 'height'];
	const attributesOf = (element) => Object.fromEntries(KEPT.flatMap((name) => element.hasAttribute(name) ? [[name, element.getAttribute(name)]] : []));
	// A mark where the chart's part lies: places are absolute in capital letters, shapes relative in small ones.
	const move = (element, across, up) => {
		const old = element.written;
		const now = {};
		// A diamond is begun at its top.
		const above = element.matches('.diamond') ? 4 : 0;
		if ('d' in old) {
			now.d = old.d.replace(/([MLHV])([-\d.]+)(?: ([-\d.]+))?/g, (_, letter, one, other) => {
				if (letter === 'H') return `H${tenth(across(+one))}`;
				if (letter === 'V') return `V${tenth(up(+one))}`;
				return `${letter}${tenth(across(+one))} ${tenth(up(+other + above) - above)}`;
			});
		} else if ('width' in old) {
			const [left, top] = [across(+old.x), up(+old.y)];
			Object.assign(now, { x: tenth(left), y: tenth(top) });
			now.width = tenth(across(+old.x + +old.width) - left);
			now.height = tenth(up(+old.y + +old.height) - top);
		}
		for (const [name, value] of Object.entries(now)) element.setAttribute(name, value);
	};

	const charts = [];
	class Zoom {
		constructor(svg) {
			this.svg = svg;
			this.frame = numbers(svg.dataset.frame);
			this.part = null;
			this.marks = svg.querySelector('.marks');
			[this.axes, this.strokes] = all('path.frame', svg);
			this.grid = svg.querySelector('path.grid');
			this.hint = document.createElement('p');
			this.hint.className = 'zoom';
			this.button = Object.assign(document.createElement('button'), { type: 'button' });
			this.told = document.createElement('span');
			this.told.setAttribute('aria-live', 'polite');
			this.hint.append(this.button, ' ', this.told);
			(svg.closest('.scroll') ?? svg).after(this.hint);
			this.tell();
		}

		// A new element of the drawing.
		make(name, attributes, before) {
			const made = document.createElementNS(this.svg.namespaceURI, name);
			for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
			this.svg.insertBefore(made, before);
			return made;
		}

		remember() {
			if (this.kept) return;
			this.kept = [this.grid, this.strokes, ...all('*', this.marks)];
			for (const element of this.kept) element.written = attributesOf(element);
			this.ticks = all('text.tick', this.svg).filter((tick) => tick.parentNode === this.svg);
			const [left, right, top, bottom] = this.frame;
			const { width, height } = this.svg.viewBox.baseVal;
			// Marks beyond the frame are hidden by a margin of the page's colour.
			const d = `M0 0H${width}V${height}H0ZM${left} ${top}V${bottom}H${right}V${top}Z`;
			this.margin = this.make('path', { class: 'margin', d }, this.axes);
		}

		// Shows the part between these edges, in pixels of the whole chart; all of it without them.
		show(part) {
			if (!part && !this.part) return;
			this.remember();
			this.part = part;
			const [left, right, top, bottom] = this.frame;
			const [l, r, t, b] = part ?? this.frame;
			const across = (x) => left + (x - l) / (r - l) * (right - left);
			const up = (y) => top + (y - t) / (b - t) * (bottom - top);
			this.svg.placed = part ? ([x, y]) => [across(x), up(y)] : undefined;
			for (const tick of all('text.tick.part', this.svg)) tick.remove();
			if (part) {
				for (const element of this.kept) if (this.marks.contains(element)) move(element, across, up);
				for (const tick of this.ticks) tick.remove();
				this.drawScales(across, up);
			} else {
				for (const element of this.kept) for (const [name, value] of Object.entries(element.written)) element.setAttribute(name, value);
				const label = this.svg.querySelector('text.label');
				for (const tick of this.ticks) this.svg.insertBefore(tick, label);
			}
			this.margin.style.display = part ? '' : 'none';
			this.tell();
			this.svg.dispatchEvent(new Event('zoomed'));
		}

		// The values at both ends of a scale's part.
		ends(name) {
			const [left, right, top, bottom] = this.frame;
			const [l, r, t, b] = this.part ?? this.frame;
			const [first, last] = numbers(this.svg.dataset[name]);
			const [from, to] = name === 'x' ? [(l - left) / (right - left), (r - left) / (right - left)]
				: [(bottom - b) / (bottom - top), (bottom - t) / (bottom - top)];
			return [first + from * (last - first), first + to * (last - first)];
		}

		ticksOf(name) {
			const kind = this.svg.dataset[`${name}Of`];
			const written = this.ticks.filter((tick) => (tick.getAttribute('text-anchor') === 'end') === (name === 'y'));
			const [low, high] = this.ends(name);
			const most = Math.max(3, written.length);
			if (kind === 'dates') return dateTicks(low, high, Math.min(most, 6));
			if (kind === 'names') return written.map((tick, k) => [k + 0.5, tick.textContent]).filter(([at]) => low <= at && at <= high);
			return roundTicks(low, high, most, kind === 'counts' ? 1 : 0);
		}

		drawScales(across, up) {
			const [left, right, top, bottom] = this.frame;
			const { width } = this.svg.viewBox.baseVal;
			const [[x0, x1], [y0, y1]] = [numbers(this.svg.dataset.x), numbers(this.svg.dataset.y)];
			const label = this.svg.querySelector('text.label');
			let [lines, strokes] = ['', ''];
			const write = (text, x, y, anchor) => {
				this.make('text', { class: 'tick part', 'text-anchor': anchor, x: tenth(x), y: tenth(y) }, label).textContent = text;
			};
			for (const [value, text] of this.ticksOf('x')) {
				const x = across(left + (value - x0) / (x1 - x0) * (right - left));
				lines += `M${tenth(x)} ${top}V${bottom}`;
				strokes += `M${tenth(x)} ${bottom}v4`;
				write(text, Math.min(x, width - 3.8 * text.length), bottom + 16, 'middle');
			}
			for (const [value, text] of this.ticksOf('y')) {
				const y = up(bottom - (value - y0) / (y1 - y0) * (bottom - top));
				lines += `M${left} ${tenth(y)}H${right}`;
				strokes += `M${left} ${tenth(y)}h-4`;
				write(text, left - 7, y + 4, 'end');
			}
			this.grid.setAttribute('d', lines);
			this.strokes.setAttribute('d', strokes);
		}

		// The words below the chart.
		tell() {
			const armed = this.svg.style.touchAction === 'none';
			this.button.textContent = this.part ? 'Whole chart' : 'Zoom';
			this.button.setAttribute('aria-pressed', String(armed && !this.part));
			if (!this.part) {
				this.told.textContent = armed ? 'draw a rectangle over the chart' : 'drag to zoom, double click to go back; keys + − 0';
				return;
			}
			const day = (number) => new Date(number * 1000).toISOString().slice(0, 10);
			const words = (name) => this.ends(name).map((end) => this.svg.dataset[`${name}Of`] === 'dates' ? day(end) : String(+end.toPrecision(3))).join(' to ');
			this.told.textContent = `${words('x')} across, ${words('y')} up; double click goes back`;
		}

		// A part of the size that can be shown, inside the frame.
		within(part) {
			const [left, right, top, bottom] = this.frame;
			const fitted = (from, to, low, high) => {
				const length = Math.min(high - low, Math.max(to - from, (high - low) / DEEPEST));
				const begin = Math.max(low, Math.min(high - length, (from + to - length) / 2));
				return [begin, begin + length];
			};
			const [l, r, t, b] = part;
			const fit = [...fitted(l, r, left, right), ...fitted(t, b, top, bottom)];
			return fit.every((edge, k) => Math.abs(edge - this.frame[k]) < 1e-6) ? null : fit;
		}

		// A place of the drawing in pixels of the whole chart.
		unzoomed([x, y]) {
			const [left, right, top, bottom] = this.frame;
			const [l, r, t, b] = this.part ?? this.frame;
			return [l + (x - left) / (right - left) * (r - l), t + (y - top) / (bottom - top) * (b - t)];
		}

		// Enlarges around the point that the arrow keys have reached, else around the middle.
		enlarge(factor) {
			const [l, r, t, b] = this.part ?? this.frame;
			const [x, y] = this.svg.stop?.point ?? [(l + r) / 2, (t + b) / 2];
			const [width, height] = [(r - l) / factor / 2, (b - t) / factor / 2];
			// A named column is enlarged along its scale alone.
			this.show(this.within([x - width, x + width, ...y === null ? [t, b] : [y - height, y + height]]));
		}

		// Moves the part by a quarter of itself.
		pan(across, up) {
			if (!this.part) return;
			const [l, r, t, b] = this.part;
			const [x, y] = [across * (r - l) / 4, -up * (b - t) / 4];
			this.show(this.within([l + x, r + x, t + y, b + y]) ?? this.part);
		}

		// Where the pointer is in the drawing, inside the frame.
		pointed(event) {
			const drawn = this.svg.getBoundingClientRect();
			const scale = drawn.width / this.svg.viewBox.baseVal.width;
			const [left, right, top, bottom] = this.frame;
			const inside = (value, low, high) => Math.max(low, Math.min(high, value));
			return [inside((event.clientX - drawn.left) / scale, left, right), inside((event.clientY - drawn.top) / scale, top, bottom)];
		}

		// The edges of a rectangle between two places; along one scale alone where it is flat.
		chosen([x0, y0], [x1, y1]) {
			const [left, right, top, bottom] = this.frame;
			const [wide, high] = [Math.abs(x1 - x0) >= SHORTEST, Math.abs(y1 - y0) >= SHORTEST];
			if (!wide && !high) return null;
			return [...wide ? [Math.min(x0, x1), Math.max(x0, x1)] : [left, right], ...high ? [Math.min(y0, y1), Math.max(y0, y1)] : [top, bottom]];
		}

		listen() {
			const { svg } = this;
			let begin = null;
			const stop = () => {
				begin = null;
				svg.dragging = false;
				this.rectangle?.remove();
			};
			svg.addEventListener('pointerdown', (event) => {
				// A finger scrolls the page unless the button was pressed before.
				if (event.button !== 0 || (event.pointerType === 'touch' && svg.style.touchAction !== 'none')) return;
				begin = this.pointed(event);
			});
			svg.addEventListener('pointermove', (event) => {
				const edges = begin && this.chosen(begin, this.pointed(event));
				if (!edges) return;
				if (!svg.dragging) {
					svg.dragging = true;
					svg.setPointerCapture(event.pointerId);
					this.rectangle = this.make('rect', { class: 'chosen' }, null);
				}
				const [l, r, t, b] = edges;
				for (const [name, value] of Object.entries({ x: l, y: t, width: r - l, height: b - t })) this.rectangle.setAttribute(name, tenth(value));
			});
			svg.addEventListener('pointerup', (event) => {
				const edges = svg.dragging && this.chosen(begin, this.pointed(event));
				stop();
				if (!edges) return;
				const [[l, t], [r, b]] = [this.unzoomed([edges[0], edges[2]]), this.unzoomed([edges[1], edges[3]])];
				svg.style.touchAction = '';
				this.show(this.within([l, r, t, b]));
			});
			svg.addEventListener('pointercancel', stop);
			svg.addEventListener('dblclick', () => this.show(null));
			svg.addEventListener('keydown', (event) => {
				if (event.ctrlKey || event.metaKey || event.altKey) return;
				const away = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
				if (event.key === '+' || event.key === '=') this.enlarge(2);
				else if (event.key === '-') this.enlarge(0.5);
				else if (event.key === '0' || event.key === 'Escape') this.show(null);
				else if (event.shiftKey && away && this.part) this.pan(...away);
				else return;
				if (event.key !== 'Escape') event.preventDefault();
			});
			this.button.addEventListener('click', () => {
				svg.style.touchAction = this.part || svg.style.touchAction === 'none' ? '' : 'none';
				this.show(null);
				this.tell();
			});
		}
	}
	for (const svg of all('svg[data-frame]')) {
		const chart = new Zoom(svg);
		chart.listen();
		charts.push(chart);
	}

	let enlarged = [];
	addEventListener('beforeprint', () => {
		enlarged = charts.filter((chart) => chart.part).map((chart) => [chart, chart.part]);
		for (const [chart] of enlarged) chart.show(null);
	});
	addEventListener('afterprint', () => { for (const [chart, part] of enlarged) chart.show(part); });
})();
