// Surfaces in three dimensions turn by dragging and by the arrow keys. Pieces name the corners that they join (`data-p`); the drawing
// has the corners once (`data-at`, in thousandths of half a side) and says how it is seen (`data-turn`). `solid.rs` draws the same.
(() => {
	'use strict';
	const { all, numbers } = page;
	const radians = (degrees) => degrees * Math.PI / 180;
	// Degrees: lower a surface is a line, higher its names leave the drawing.
	const [LOWEST, HIGHEST] = [8, 60];
	// Degrees of a press of a key, and of a pixel.
	const [PRESS, PIXEL] = [10, 0.5];
	const written = (number) => String(Math.round(number * 10) / 10);

	for (const svg of all('svg[data-turn]')) {
		const [azimuth, elevation, middleX, middleY, scale] = svg.dataset.turn.split(' ').map(Number);
		const corners = svg.dataset.at.split(',').map((corner) => corner.split(' ').map((one) => one / 1000));
		// Dots are as far away as the facet that they are on.
		const pieces = all('[data-p]', svg).map((element) => {
			const at = numbers(element.dataset.p);
			return { element, at, on: element.dataset.on ? numbers(element.dataset.on) : at };
		});
		// Scales keep to the sides that are nearest, and the upright one to the left.
		const isScale = (element) => element.matches('text,.frame');
		const sided = ([first, second, third], element, sin, cos) => {
			// Words are beside the box: beyond the end of one scale, or of two where they are those of the upright one.
			const [besideFirst, besideSecond] = [first, second].map((one) => Math.abs(one) > 1);
			if (element.matches('.frame') || (besideFirst && besideSecond)) return [-Math.sign(cos) * Math.abs(first), Math.sign(sin) * Math.abs(second), third];
			return besideFirst ? [-Math.sign(sin) * Math.abs(first), second, third] : [first, -Math.sign(cos) * Math.abs(second), third];
		};
		const group = svg.querySelector('.pieces');
		const solid = pieces.filter(({ element }) => element.parentNode === group);
		let view = [azimuth, elevation];

		const draw = () => {
			const [sin, cos] = [Math.sin(radians(view[0])), Math.cos(radians(view[0]))];
			const [sinElevation, cosElevation] = [Math.sin(radians(view[1])), Math.cos(radians(view[1]))];
			const see = ([first, second, third]) => {
				const away = first * sin + second * cos;
				const up = third * cosElevation + away * sinElevation;
				return [written(middleX + scale * (first * cos - second * sin)), written(middleY - scale * up), away];
			};
			for (const piece of pieces) {
				const { element, at, on } = piece;
				const placed = (corner) => see(isScale(element) ? sided(corners[corner], element, sin, cos) : corners[corner]);
				const seen = at.map(placed);
				piece.away = on.reduce((sum, corner) => sum + placed(corner)[2], 0) / on.length;
				if (element.matches('text')) {
					element.setAttribute('x', seen[0][0]);
					element.setAttribute('y', seen[0][1]);
					continue;
				}
				const [facet, dots] = ['cell', 'dot'].map((name) => element.classList.contains(name));
				const begins = (k) => dots || (facet ? k === 0 : k % 2 === 0);
				const d = seen.map(([x, y], k) => `${begins(k) ? 'M' : 'L'}${x} ${y}${dots ? 'h0' : ''}`);
				element.setAttribute('d', d.join('') + (facet ? 'Z' : ''));
			}
			group.append(...solid.sort((one, other) => other.away - one.away).map(({ element }) => element));
		};
		// What is nearest follows the pointer: to the right, and down as the eye goes up.
		const turn = (by, raise) => {
			view = [(view[0] + by) % 360, Math.max(LOWEST, Math.min(HIGHEST, view[1] + raise))];
			draw();
		};
		const home = () => {
			view = [azimuth, elevation];
			draw();
		};

		let last = null;
		svg.addEventListener('pointerdown', (event) => { if (event.button === 0) last = [event.clientX, event.clientY]; });
		svg.addEventListener('pointermove', (event) => {
			if (!last) return;
			if (!svg.dragging) svg.setPointerCapture(event.pointerId);
			svg.dragging = true;
			turn((event.clientX - last[0]) * PIXEL, (event.clientY - last[1]) * PIXEL);
			last = [event.clientX, event.clientY];
		});
		for (const name of ['pointerup', 'pointercancel']) svg.addEventListener(name, () => {
			last = null;
			svg.dragging = false;
		});
		svg.addEventListener('dblclick', home);
		svg.addEventListener('keydown', (event) => {
			if (event.ctrlKey || event.metaKey || event.altKey) return;
			const by = { ArrowLeft: [-PRESS, 0], ArrowRight: [PRESS, 0], ArrowUp: [0, -PRESS], ArrowDown: [0, PRESS] }[event.key];
			if (by) turn(...by);
			else if (event.key === '0' || event.key === 'Escape') home();
			else return;
			event.preventDefault();
		});
		const hint = Object.assign(document.createElement('p'), { className: 'zoom' });
		hint.textContent = 'drag or arrow keys to turn, double click or 0 to go back';
		svg.after(hint);
	}
})();
