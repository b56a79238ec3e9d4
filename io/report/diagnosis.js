"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  tumblePlots.drawAll(data.plots);
  const { svg, minus, R, polyline, shade, squares, follow } = tumbleMaps;
  const maps = data.maps.all, get = id => document.getElementById(id);
  if (!maps.length) return;

  const top = map => 2 * (map.limit ?? 3);  // the deepest shade
  const worst = z => z.reduce((most, v) => Math.max(most, Math.abs(v ?? 0)), 0);
  const beyond = (map, z, k) => map.limit != null && z[k] != null && Math.abs(z[k]) > map.limit;

  // Pockets turn with the drum: a ring of sectors, the first behind lifter 0, on the right.
  const inner = 0.7;
  const sector = (k, count) => {
    const [a, b] = [k, k + 1].map(i => 2 * Math.PI * i / count), at = (r, t) => [r * Math.cos(t), r * Math.sin(t)];
    const steps = Array.from({ length: 7 }, (_, i) => a + (b - a) * i / 6);
    return polyline([...steps.map(t => at(0.99, t)), ...steps.reverse().map(t => at(inner, t))]) + "z";
  };

  const draw = (place, map, side, large) => {
    const z = map["z_" + side], shape = data.maps.shapes[map.experiment];
    place.replaceChildren(svg("circle", { class: "inside", r: R }));
    if (map.n) {
      const { shades, rims } = squares(map.n, k => z[k] == null ? null : z[k] / top(map), k => beyond(map, z, k));
      const inner = svg("g", { "clip-path": "url(#mill-inside)" });  // squares at the rim reach beyond the shell
      inner.append(shades, svg("path", { class: "named", d: rims }));
      place.append(inner);
    } else {
      z.forEach((v, k) => v != null && place.append(svg("path", { class: "pocket " + shade(v / top(map)).class, "fill-opacity": shade(v / top(map))["fill-opacity"], d: sector(k, z.length) })));
      place.append(svg("path", { class: "named", d: z.map((_, k) => beyond(map, z, k) ? sector(k, z.length) : "").join("") }));
      if (large) z.forEach((_, k) => {
        const t = 2 * Math.PI * (k + 0.5) / z.length;
        if (z.length <= 24 || k % 2 == 0) place.append(svg("text", { class: "lifter", x: (0.6 * R * Math.cos(t)).toFixed(1), y: (-0.6 * R * Math.sin(t) + 2.5).toFixed(1), "text-anchor": "middle" }, k));
      });
    }
    place.append(shape?.outline ? svg("path", { class: "shell", "fill-rule": "evenodd", d: `M104 0A104 104 0 1 0 -104 0A104 104 0 1 0 104 0z${shape.outline}` })
      : svg("circle", { class: "rim", r: R }));
  };

  for (const button of document.querySelectorAll(".map-button"))
    for (const place of button.querySelectorAll("svg")) draw(place, maps[button.dataset.map], place.dataset.side, false);

  // --- the two large ones
  const large = [...document.querySelectorAll(".maps svg")];
  let shown = null, at = null;
  const digits = v => v == null ? "–" : minus(Number(v.toPrecision(3)));
  const mark = k => {
    for (const place of large) {
      place.querySelector(".cursor")?.remove();
      place.append(shown.n ? svg("rect", { class: "cursor", x: ((k % shown.n) * 2 / shown.n - 1) * R, y: (1 - (Math.floor(k / shown.n) + 1) * 2 / shown.n) * R, width: 2 * R / shown.n, height: 2 * R / shown.n })
        : svg("path", { class: "cursor", d: sector(k, shown.z_before.length) }));
    }
  };
  const read = k => {
    at = k;
    mark(k);
    let where = `lifter ${k}`;
    if (shown.n) {
      const x = (k % shown.n + 0.5) * 2 / shown.n - 1, y = (Math.floor(k / shown.n) + 0.5) * 2 / shown.n - 1;
      where = `${((Math.atan2(y, x) * 180 / Math.PI + 360) % 360).toFixed(0)}°, ${Math.hypot(x, y).toFixed(2)} R`;
    }
    const unit = shown.unit ? " " + shown.unit : "", z = side => shown["z_" + side][k];
    const told = side => shown["z_" + side].length ? `; ${side} ${digits(shown[side][k])}, z = ${digits(z(side))}` : "";
    get("map-reading").textContent = z("before") == null ? `${where}: not compared`
      : `${where}: measured ${digits(shown.measured[k])}${unit}${told("before")}${told("after")}`;
  };
  const choose = index => {
    shown = maps[index];
    at = null;
    for (const place of large) draw(place, shown, place.dataset.side, true);
    get("map-scale").replaceChildren(...[["b", minus(-top(shown))], ["i", ""], ["b", String(top(shown))]].map(([name, text]) => Object.assign(document.createElement(name), { textContent: text })), " standard errors");
    get("map-title").textContent = `${shown.observable}, ${shown.experiment}. ${shown.meaning}`;
    get("map-reading").textContent = "Point at a cell, or come here with the tab key and use the arrow keys.";
    for (const button of document.querySelectorAll(".map-button")) button.setAttribute("aria-pressed", button.dataset.map == index);
  };
  for (const button of document.querySelectorAll(".map-button")) button.addEventListener("click", () => choose(Number(button.dataset.map)));
  for (const place of large) {
    follow(place, () => shown.n || 2, () => at, k => shown.n && read(k));
    // Pockets by pointer and by keys.
    place.addEventListener("pointermove", e => {
      if (shown.n) return;
      const p = new DOMPoint(e.clientX, e.clientY).matrixTransform(place.getScreenCTM().inverse()), count = shown.z_before.length;
      if (Math.hypot(p.x, p.y) < R) read(Math.floor(((Math.atan2(-p.y, p.x) / 2 / Math.PI) + 1) % 1 * count));
    });
    place.addEventListener("keydown", e => {
      const step = { ArrowLeft: 1, ArrowRight: -1, ArrowUp: 1, ArrowDown: -1 }[e.key];
      if (shown.n || !step) return;
      e.preventDefault();
      const count = shown.z_before.length;
      read(((at ?? 0) + step + count) % count);
    });
  }
  // The map that shows most comes first.
  const strength = map => worst(map.z_before) / (map.limit ?? 3);
  choose(maps.reduce((best, map, i) => strength(map) > strength(maps[best]) ? i : best, 0));
})();
