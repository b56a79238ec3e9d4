"use strict";
// What pages with maps of the mill's cross-section share.
const tumbleMaps = (() => {
  const R = 100;  // picture units of a mill radius
  const svg = (name, attributes, text) => {
    const e = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    if (text != null) e.textContent = text;
    return e;
  };
  const minus = text => String(text).replace("-", "−");
  const point = (x, y) => `${(x * R).toFixed(2)} ${(-y * R).toFixed(2)}`;
  const polyline = points => points.length < 2 ? "" : "M" + points.map(p => point(...p)).join("L");
  const shade = share => ({ class: share > 0 ? "more" : "less", "fill-opacity": (0.9 * Math.min(1, Math.abs(share))).toFixed(2) });

  // n x n squares over the mill, row by row from the lowest y, shaded by share(k) of the scale (null: not drawn); and the
  // rims of those that is_named(k), as one path: where one that is meets one that is not.
  const squares = (n, share, is_named) => {
    const cell = 2 / n, shades = svg("g", {}), named = (i, j) => i >= 0 && j >= 0 && i < n && j < n && is_named(j * n + i);
    let rims = "";
    for (let k = 0; k < n * n; ++k) {
      const of = share(k), i = k % n, j = Math.floor(k / n), x = i * cell - 1, y = j * cell - 1;
      if (of == null) continue;
      if (Math.abs(of) > 0.03)
        shades.append(svg("rect", { x: (x * R).toFixed(2), y: (-(y + cell) * R).toFixed(2), width: (cell * R).toFixed(2), height: (cell * R).toFixed(2), ...shade(of) }));
      if (!named(i, j)) continue;
      for (const [di, dj, from, to] of [[-1, 0, [0, 0], [0, 1]], [1, 0, [1, 0], [1, 1]], [0, -1, [0, 0], [1, 0]], [0, 1, [0, 1], [1, 1]]])
        if (!named(i + di, j + dj)) rims += polyline([from, to].map(p => [x + p[0] * cell, y + p[1] * cell]));
    }
    return { shades, rims };
  };

  // Reads cell k of the map under the pointer or by arrow keys; `grid`: cells along its edge, `at`: the one read last, or
  // null.
  const follow = (map, grid, at, read) => {
    map.addEventListener("pointermove", e => {
      const n = grid(), p = new DOMPoint(e.clientX, e.clientY).matrixTransform(map.getScreenCTM().inverse());
      const i = Math.floor((p.x / R + 1) * n / 2), j = Math.floor((1 - p.y / R) * n / 2);
      if (Math.hypot(p.x, p.y) < R && i >= 0 && j >= 0 && i < n && j < n) read(j * n + i);
    });
    map.addEventListener("keydown", e => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key], n = grid();
      if (!step) return;
      e.preventDefault();
      const from = at() ?? Math.floor(n / 2) * n + Math.floor(n / 2), i = from % n + step[0], j = Math.floor(from / n) + step[1];
      if (Math.hypot((i + 0.5) * 2 / n - 1, (j + 0.5) * 2 / n - 1) < 1) read(j * n + i);
    });
  };
  return { R, svg, minus, point, polyline, shade, squares, follow };
})();
