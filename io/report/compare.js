"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  tumblePlots.drawAll(data.plots);
  const { svg, minus, R, point, polyline, shade, squares, follow } = tumbleMaps;
  const get = id => document.getElementById(id);
  const rounded = (v, se) => v == null ? "–" : minus(v.toFixed(se > 0 ? Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(se)))) : 3));

  // --- the map of differences
  const map = get("map"), n = data.map.n;
  const fields = data.map.fields, names = Object.keys(fields);
  const words = { occupancy: "occupancy", velocity_x: "velocity to the right, m/s", velocity_y: "velocity upwards, m/s" };
  const ray = (deg, from, to) => {
    const c = Math.cos(deg * Math.PI / 180), s = Math.sin(deg * Math.PI / 180);
    return "M" + point(from * c, from * s) + "L" + point(to * c, to * s);
  };
  const dial = place => {  // toe, shoulder and surface of both
    data.sides.forEach((side, k) => {
      const of = k ? "found" : "truth";
      place.append(svg("path", { class: `surface layer-surface ${of}`, d: polyline(side.surface) }));
      const marks = [["toe", side.toe], ["shoulder", side.shoulder]].filter(m => m[1][0] != null);
      for (const [name, levels] of marks)
        levels.forEach((deg, level) => deg != null && place.append(svg("path", {
          class: `${level ? "level" : "mark"} layer-mark ${of}`, d: ray(deg, level ? 1.01 : data.tip * 0.86, level ? 1.05 : 1.08) })));
    });
  };
  // B − A of the velocity as arrows, means over blocks of cells; what they stand for goes beside the scale.
  const velocityArrows = bar => {
    const vx = fields.velocity_x, vy = fields.velocity_y, block = Math.max(1, Math.round(n / 20)), cell = 2 / n, arrows = [];
    for (let row = 0; row + block <= n; row += block)
      for (let column = 0; column + block <= n; column += block) {
        let x = 0, y = 0, known = 0;
        for (let k = 0; k < block * block; ++k) {
          const i = (row + Math.floor(k / block)) * n + column + k % block;
          if (vx.z[i] == null || vy.z[i] == null) continue;
          x += vx.d[i];
          y += vy.d[i];
          ++known;
        }
        if (2 * known > block * block) arrows.push([(column + block / 2) * cell - 1, (row + block / 2) * cell - 1, x / known, y / known]);
      }
    const sizes = arrows.map(a => Math.hypot(a[2], a[3])).sort((a, b) => a - b), long = sizes[Math.floor(sizes.length * 0.97)];
    if (!long) return;
    let d = "";
    for (const [x, y, dx, dy] of arrows) {
      const by = Math.min(1.25 * block * cell / long, 2 * block * cell / Math.hypot(dx, dy));  // a few far ones do not cross the mill
      const [u, v] = [dx * by, dy * by], [tx, ty] = [x + u / 2, y + v / 2];
      if (Math.hypot(u, v) < 0.2 * block * cell) continue;
      d += polyline([[x - u / 2, y - v / 2], [tx, ty]]) +
        polyline([[tx - 0.3 * u - 0.18 * v, ty - 0.3 * v + 0.18 * u], [tx, ty], [tx - 0.3 * u + 0.18 * v, ty - 0.3 * v - 0.18 * u]]);
    }
    map.append(svg("path", { class: "arrows", d }));
    const length = 1.25 * block * cell * R;
    bar.append(svg("path", { class: "arrows", d: `M0 46h${length.toFixed(2)}m-3 -1.8l3 1.8l-3 1.8` }),
      svg("text", { x: 0, y: 55 }, `${Number(long.toPrecision(2))} m/s`));
  };
  const drawMap = () => {
    if (!names.length) return;
    const name = get("map-of").value, in_errors = get("map-z").checked, f = fields[name];
    const shown = in_errors ? f.z : f.d;
    const sizes = shown.filter((v, i) => v != null && f.z[i] != null).map(Math.abs).sort((a, b) => a - b);
    const top = in_errors ? 6 : sizes[Math.floor(sizes.length * 0.99)] || 1;
    map.replaceChildren(svg("circle", { class: "inside", r: R }));
    const { shades, rims } = squares(n, k => shown[k] == null || f.z[k] == null ? null : shown[k] / top, k => f.named[k] == 1);
    shades.classList.add("layer-shade");
    map.append(shades, svg("circle", { class: "rim", r: R }));
    if (data.tip < 0.999) map.append(svg("circle", { class: "tips", r: (R * data.tip).toFixed(2) }));
    map.append(svg("path", { class: "named layer-named", d: rims }));
    dial(map);
    for (const [k, side] of data.sides.entries())
      for (const path of side.paths) map.append(svg("path", { class: `path layer-path ${k ? "found" : "truth"}`, d: polyline(path.points) }));
    const bar = svg("g", { class: "scale", transform: "translate(118 46)" });
    [-1, -0.5, 0, 0.5, 1].forEach((v, i) => {
      bar.append(svg("rect", { x: 0, y: 34 - 10 * i - 10, width: 8, height: 10, ...shade(v) }));
      if (i % 2 == 0) bar.append(svg("text", { x: 11, y: 34 - 10 * i - 2.5 }, minus(String(Number((v * top).toPrecision(2)))) + (in_errors && v ? " se" : "")));
    });
    if (name != "occupancy" && fields.velocity_x && fields.velocity_y) velocityArrows(bar);
    map.append(bar, cursor);
    applyLayers();
  };
  const cursor = svg("rect", { class: "cursor", width: 200 / n, height: 200 / n, visibility: "hidden" });
  let at = null;
  const read = k => {
    const f = fields[get("map-of").value], x = (k % n + 0.5) * 2 / n - 1, y = (Math.floor(k / n) + 0.5) * 2 / n - 1;
    at = k;
    cursor.setAttribute("x", ((x - 1 / n) * R).toFixed(2));
    cursor.setAttribute("y", (-(y + 1 / n) * R).toFixed(2));
    cursor.setAttribute("visibility", "visible");
    const deg = (Math.atan2(y, x) * 180 / Math.PI + 360) % 360;
    const of = (v, se) => v == null ? "–" : `${rounded(v, se)}${se > 0 ? " ± " + rounded(se, se) : ""}`;
    get("map-reading").textContent = `${deg.toFixed(0)}°, ${Math.hypot(x, y).toFixed(2)} R: A ${of(f.a[k], f.ase[k])}, B ${of(f.b[k], f.bse[k])}` +
      (f.z[k] == null ? ", not compared" : `, B − A = ${of(f.d[k], f.se[k])}, z = ${minus(f.z[k].toFixed(1))}${f.named[k] ? ", beyond chance" : ""}`);
  };
  if (names.length) {
    for (const name of names) get("map-of").append(new Option(words[name] ?? name, name));
    follow(map, () => n, () => at, read);
    for (const id of ["map-of", "map-z"]) get(id).addEventListener("change", () => { drawMap(); if (at != null) read(at); });
  } else {
    document.querySelector(".difference").hidden = true;
  }

  // --- layers of the pictures
  const marks = { shade: ".shade, .layer-shade", arrows: ".arrows", mark: ".mark, .layer-mark, .mill:not(.map) text", other: ".other", surface: ".layer-surface", named: ".layer-named", path: ".layer-path" };
  const boxes = [...document.querySelectorAll("#layers input")];
  const applyLayers = () => {
    for (const box of boxes)
      for (const part of document.querySelectorAll(marks[box.dataset.layer]))
        if (part.closest(".pictures, .difference")) part.style.display = box.checked ? "" : "none";
  };
  boxes.forEach(box => box.addEventListener("change", applyLayers));
  drawMap();
  applyLayers();

  // --- paths
  const choosers = [get("path-a"), get("path-b")], picture = get("path-picture");
  const drawPaths = () => {
    picture.replaceChildren(svg("circle", { class: "inside", r: R }), svg("circle", { class: "rim", r: R }));
    if (data.tip < 0.999) picture.append(svg("circle", { class: "tips", r: (R * data.tip).toFixed(2) }));
    data.sides.forEach((side, k) => {
      const path = side.paths[choosers[k].value], of = k ? "found" : "truth";
      if (!path) return;
      picture.append(svg("path", { class: `path ${of}`, d: polyline(path.points) }));
      for (let t = 0, i = 0; i < path.points.length; ++i)
        if (path.time[i] >= t - 1e-9) {
          picture.append(svg("circle", { class: `dot ${of}`, cx: (path.points[i][0] * R).toFixed(2), cy: (-path.points[i][1] * R).toFixed(2), r: i ? 1.4 : 2.6 }));
          t += data.path_dots;
        }
    });
  };
  data.sides.forEach((side, k) => side.paths.forEach((path, i) => choosers[k].append(
    new Option((path.share == null ? `ball ${path.ball}` : `${Math.round(path.share * 100)} % of turns stay inside (ball ${path.ball}`) +
      `${path.share == null ? " (" : ", "}${(path.time.at(-1) ?? 0).toFixed(2)} s)`, i))));
  choosers.forEach((chooser, k) => {
    chooser.selectedIndex = Math.floor(data.sides[k].paths.filter(path => path.share != null).length / 2);
    chooser.addEventListener("change", () => {
      const rank = data.sides[k].paths[chooser.value].share;
      if (get("path-together").checked && rank != null)
        choosers[1 - k].selectedIndex = Math.max(0, data.sides[1 - k].paths.findIndex(path => path.share == rank));
      drawPaths();
    });
  });
  drawPaths();

  // --- films in step: one clock for all, a slider over it
  const films = [...document.querySelectorAll("video")], slider = get("film-time");
  if (films.length && slider) {
    const play = get("film-play"), clock = get("film-clock"), speed = get("film-speed");
    let length = 0, shown = 0, last = 0, running = false;
    const show = t => {
      shown = Math.min(Math.max(t, 0), length);
      slider.value = length ? Math.round(1000 * shown / length) : 0;
      clock.textContent = (shown / data.film_slow).toFixed(2) + " s";
    };
    const seek = t => { show(t); for (const film of films) film.currentTime = shown; };
    const stop = () => { running = false; films.forEach(film => film.pause()); play.textContent = "Play"; };
    const follow = now => {
      if (!running) return;
      const lead = films[0];
      show(lead.currentTime);
      // Whoever is off by more than a picture is put right; the players' own clocks drift.
      for (const film of films) if (Math.abs(film.currentTime - lead.currentTime) > 0.06 && !film.seeking) film.currentTime = lead.currentTime;
      if (lead.ended || shown >= length - 0.02) films.forEach(film => { film.currentTime = 0; film.play().catch(stop); });
      last = now;
      requestAnimationFrame(follow);
    };
    const start = () => {
      running = true;
      play.textContent = "Pause";
      films.forEach(film => { film.playbackRate = Number(speed.value); film.play().catch(stop); });
      requestAnimationFrame(follow);
    };
    const known = () => { const all = films.map(film => film.duration); if (all.every(d => d > 0)) { length = Math.min(...all); seek(0); } };
    films.forEach(film => {
      film.addEventListener("loadedmetadata", known);
      // Some browsers want a film in pieces, which a data: address cannot give; a blob can.
      film.addEventListener("error", () => {
        if (!film.src.startsWith("data:")) return;
        const bytes = Uint8Array.from(atob(film.src.split(",")[1]), c => c.charCodeAt(0));
        film.src = URL.createObjectURL(new Blob([bytes], { type: "video/mp4" }));
      });
    });
    known();
    play.addEventListener("click", () => running ? stop() : start());
    speed.addEventListener("change", () => films.forEach(film => film.playbackRate = Number(speed.value)));
    slider.addEventListener("input", () => { stop(); seek(length * slider.value / 1000); });
    get("films").addEventListener("keydown", e => {
      if (e.target == slider || e.target.tagName == "SELECT") return;
      if (e.key == "," || e.key == ".") { stop(); seek(shown + (e.key == "." ? 1 : -1) / data.film_rate); }
    });
  }
})();
