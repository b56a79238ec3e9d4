"use strict";
// What the pages' plots share: looks, sizes, marks beside uPlot's own, and drawAll() for the plots of io/plot_page.h.
const tumblePlots = (() => {
  const root = getComputedStyle(document.documentElement);
  const colour = name => () => root.getPropertyValue("--" + name).trim();
  const ink = colour("ink"), soft = colour("soft"), grid = colour("grid"), truth = colour("truth"), found = colour("found");
  const faint = of => () => of() + "22", pale = of => () => of() + "88";
  const palette = ["truth", "found", "blue", "green", "violet", "gold", "pink", "teal"];
  const font = "12px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
  const digits = n => (u, v) => v == null ? "–" : v.toFixed(n);
  const degree = v => ((v % 360) + 360) % 360;
  const plots = [];

  const axis = (label, more) => Object.assign(
    { label, labelFont: font, font, stroke: soft, labelSize: 22, size: 46, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1 } }, more);
  const line = (label, stroke, more) => Object.assign({ label, stroke, width: 1.6, points: { show: false }, spanGaps: true }, more);

  // Draws inside the plot's frame only, and leaves the context as it was.
  const inside = (u, draw) => {
    const c = u.ctx;
    c.save();
    c.beginPath();
    c.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    c.clip();
    draw(c);
    c.restore();
  };

  const letter = (c, text, x, y, align) => {
    if (!text) return;
    c.font = font.replace("12px", 12 * devicePixelRatio + "px");
    c.textAlign = align;
    c.fillText(text, x, y);
  };

  // Upright lines at given places: [x, stroke, dash, label].
  const uprights = lines => u => inside(u, c => {
    for (const [x, stroke, dash, label] of lines) {
      if (x == null || x < u.scales.x.min || x > u.scales.x.max) continue;
      const at = u.valToPos(x, "x", true), right = at > u.bbox.left + u.bbox.width / 2;
      c.beginPath();
      c.setLineDash(dash.map(d => d * devicePixelRatio));
      c.lineWidth = 1.4 * devicePixelRatio;
      c.strokeStyle = c.fillStyle = stroke();
      c.moveTo(at, u.bbox.top);
      c.lineTo(at, u.bbox.top + u.bbox.height);
      c.stroke();
      letter(c, label, at + (right ? -5 : 5) * devicePixelRatio, u.bbox.top + 14 * devicePixelRatio, right ? "right" : "left");
    }
  });

  // A level band from low to high behind the lines, with a line at its middle.
  const band = (low, high, stroke) => u => {
    if (low == null) return;
    inside(u, c => {
      const top = u.valToPos(high, "y", true), bottom = u.valToPos(low, "y", true);
      c.fillStyle = stroke() + "44";
      c.fillRect(u.bbox.left, top, u.bbox.width, Math.max(bottom - top, 1));
      c.fillStyle = stroke();
      c.fillRect(u.bbox.left, (top + bottom) / 2 - devicePixelRatio / 2, u.bbox.width, devicePixelRatio);
    });
  };

  // The same upright.
  const upright_band = (low, high, stroke) => u => {
    if (low == null) return;
    inside(u, c => {
      const left = u.valToPos(low, "x", true);
      c.fillStyle = stroke() + "44";
      c.fillRect(left, u.bbox.top, u.valToPos(high, "x", true) - left, u.bbox.height);
    });
  };

  // Arrow keys read values, + and - zoom where they read, 0 shows all: what the mouse does.
  const by_keys = (u, place) => {
    const x = u.data[0], first = x[0], last = x.at(-1);
    place.tabIndex = 0;
    place.setAttribute("role", "application");
    place.setAttribute("aria-label", (place.getAttribute("aria-label") ?? "Plot") + "; arrow keys read values, plus and minus zoom, 0 shows all");
    place.addEventListener("blur", () => u.setCursor({ left: -10, top: -10 }));
    place.addEventListener("keydown", e => {
      if (e.target != place || e.ctrlKey || e.metaKey || e.altKey) return;
      const { min, max } = u.scales.x, at = u.cursor.idx;
      const seen = x.flatMap((v, i) => v >= min && v <= max ? [i] : []);
      const step = { ArrowRight: 1, ArrowLeft: -1 }[e.key];
      if (step && seen.length) {
        const next = at == null || u.cursor.left < 0 ? seen[step > 0 ? 0 : seen.length - 1]
          : Math.min(Math.max(at + step * (e.shiftKey ? 10 : 1), seen[0]), seen.at(-1));
        u.setCursor({ left: u.valToPos(x[next], "x"), top: 1 });
      } else if (e.key == "+" || e.key == "-") {
        const middle = at == null || u.cursor.left < 0 ? (min + max) / 2 : x[at], by = e.key == "+" ? 0.5 : 2;
        const low = Math.max(first, middle - (middle - min) * by), high = Math.min(last, middle + (max - middle) * by);
        if (high > low) u.setScale("x", { min: low, max: high });
      } else if (e.key == "0") {
        u.setScale("x", { min: first, max: last });
      } else {
        return;
      }
      e.preventDefault();
    });
  };

  const plot = (id, options, columns) => {
    const place = document.getElementById(id);
    if (!place || !columns[0].length) return null;
    const tall = place.classList.contains("tall"), between = (low, v, high) => Math.round(Math.min(Math.max(v, low), high));
    const size = () => {
      const width = Math.max(place.clientWidth, 200);
      return { width, height: tall ? between(300, 0.26 * width, 460) : between(240, 0.44 * width, 400) };
    };
    const u = new uPlot(Object.assign({ cursor: { y: false, points: { size: 6 } } }, size(), options), columns, place);
    new ResizeObserver(() => u.setSize(size())).observe(place);
    // On paper a plot keeps the size of its letters and takes the page's width.
    addEventListener("beforeprint", () => u.setSize(place.closest(".pair") ? { width: 320, height: 220 } : { width: 660, height: 280 }));
    addEventListener("afterprint", () => u.setSize(size()));
    // Names in the legend hide and show their line by click; so that keys do it too:
    for (const name of [...u.root.querySelectorAll(".u-legend .u-series th")].slice(1)) {
      name.tabIndex = 0;
      name.setAttribute("role", "button");
      name.addEventListener("keydown", e => {
        if (e.key != "Enter" && e.key != " ") return;
        e.preventDefault();
        name.click();
      });
    }
    by_keys(u, place);
    plots.push(u);
    return u;
  };

  const redraw = () => plots.forEach(u => u.redraw(false));
  addEventListener("themechange", redraw);
  matchMedia("print").addEventListener("change", redraw);

  // A number as a reader writes it, of at most n digits: 0.25, 1200, 4.5×10⁵.
  const in_words = (v, n) => {
    if (v == null) return "";
    if (v == 0) return "0";
    const size = Math.abs(v), minus = text => text.replace("-", "−");
    if (size >= 1e-3 && size < 1e5) return minus(String(Number(v.toPrecision(n))));
    const [front, power] = v.toExponential(n - 1).split("e");
    const raised = power.replace("+", "").replace("-", "⁻").replace(/[0-9]/g, d => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]);
    const digits = String(Number(front));
    return minus(digits == "1" ? "10" : digits == "-1" ? "-10" : digits + "×10") + raised;
  };

  // One column of x for all series. Where a series has the same x several times, so has the column: uPlot.join would
  // keep the last of them only. What a series does not have there is undefined, which is no gap in its line.
  const aligned = series => {
    const most = new Map();
    for (const s of series) {
      const here = new Map();
      for (const x of s.x) here.set(x, (here.get(x) ?? 0) + 1);
      for (const [x, count] of here) most.set(x, Math.max(most.get(x) ?? 0, count));
    }
    const x = [], first = new Map();
    for (const value of [...most.keys()].sort((a, b) => a - b)) {
      first.set(value, x.length);
      for (let k = most.get(value); k > 0; --k) x.push(value);
    }
    return [x, ...series.map(s => {
      const column = Array(x.length), used = new Map();
      s.x.forEach((value, i) => {
        const k = used.get(value) ?? 0;
        used.set(value, k + 1);
        column[first.get(value) + k] = s.y[i];
      });
      return column;
    })];
  };

  // Standard errors: bars at points, a band round a line or steps.
  const errors = (s, index, stroke) => u => inside(u, c => {
    if (!s.low || !u.series[index].show) return;
    const at = i => u.valToPos(s.x[i], "x", true), y = v => u.valToPos(v, "y", true);
    if (s.mark == "points") {
      c.strokeStyle = pale(stroke)();
      c.lineWidth = 1.3 * devicePixelRatio;
      const cap = 3 * devicePixelRatio;
      s.x.forEach((_, i) => {
        if (s.low[i] == null || s.high[i] == null) return;
        const [x, low, high] = [at(i), y(s.low[i]), y(s.high[i])];
        c.beginPath();
        c.moveTo(x, low);
        c.lineTo(x, high);
        for (const end of [low, high]) {
          c.moveTo(x - cap, end);
          c.lineTo(x + cap, end);
        }
        c.stroke();
      });
      return;
    }
    c.fillStyle = stroke() + "33";
    const stepped = s.mark == "steps";
    for (let i = 0; i < s.x.length;) {
      let end = i;
      while (end < s.x.length && s.low[end] != null && s.high[end] != null) ++end;
      const upper = [], lower = [];
      for (let k = i; k < end; ++k) {
        if (stepped && k > i) { upper.push([at(k), y(s.high[k - 1])]); lower.push([at(k), y(s.low[k - 1])]); }
        upper.push([at(k), y(s.high[k])]);
        lower.push([at(k), y(s.low[k])]);
      }
      if (upper.length > 1) {
        c.beginPath();
        for (const corner of [...upper, ...lower.reverse()]) c.lineTo(...corner);
        c.fill();
      }
      i = Math.max(end, i + 1);
    }
  });

  // The range of an axis: all that it shows, and a little more round it.
  const range_of = (log, values) => {
    const seen = values.filter(v => v != null && (!log || v > 0));
    if (!seen.length) return log ? [1, 10] : [0, 1];
    const low = seen.reduce((a, b) => Math.min(a, b)), high = seen.reduce((a, b) => Math.max(a, b));
    if (log) {
      const room = Math.max((high / low) ** 0.06, 1.08);
      return [low / room, high * room];
    }
    const room = 0.07 * (high - low || Math.abs(high) || 1);
    return [low >= 0 && low < room ? 0 : low - room, high <= 0 && high > -room ? 0 : high + room];
  };

  // Over many decades powers of ten alone, over few also steps between them, within half a decade round steps.
  const log_ticks = (u, index, low, high) => {
    const decades = Math.log10(high / low), first = Math.floor(Math.log10(low)), out = [];
    const room = index == 0 ? (u.width - 70) / 55 : (u.height - 70) / 22;  // the frame's own size is still to come
    if (decades < 0.6) {
      const rough = (high - low) / 5, size = 10 ** Math.floor(Math.log10(rough));
      const step = [1, 2, 5, 10].find(k => k * size >= rough) * size;
      for (let k = Math.ceil(low / step); k * step <= high; ++k) out.push(k * step);
      return out;
    }
    const every = Math.max(1, Math.ceil(decades / room));
    const named = decades > room / 3 ? [1] : decades > 1.5 ? [1, 2, 5] : [1, 2, 3, 5, 7];
    for (let n = first; n <= Math.log10(high); ++n)
      if (n % every == 0) for (const k of named) if (k * 10 ** n >= low && k * 10 ** n <= high) out.push(k * 10 ** n);
    return out;
  };

  const draw = spec => {
    const stroke = spec.series.map(s => colour(palette[s.colour % palette.length]));
    const xs = [...spec.series.flatMap(s => s.x), ...spec.upright.flatMap(r => [r.at, r.low, r.high])];
    // uPlot asks for the range of x first, and sets its scales when it has all of them.
    let from = -Infinity, to = Infinity;
    const window = (low, high) => {
      [from, to] = low == first && high == last || first == last ? range_of(spec.x_log, xs) : [low, high];
      return [from, to];
    };
    const heights = u => {
      const all = [];
      spec.series.forEach((s, k) => {
        if (!u.series[k + 1].show) return;
        const near = s.x.map((x, i) => x >= from && x <= to || s.x[i + 1] >= from && x < from || s.x[i - 1] <= to && x > to);
        for (const values of [s.y, s.low ?? [], s.high ?? []]) all.push(...values.filter((_, i) => near[i]));
      });
      for (const r of spec.level) all.push(r.at, r.low, r.high);
      if (spec.y_from_zero) all.push(0);
      return all;
    };
    const values = (u, at) => at.map(v => in_words(v, 6));
    const ticks = log => log ? { values, splits: log_ticks, filter: (u, at) => at } : { values };
    const round = { values: (u, at) => at.map(v => in_words(degree(v), 6)), incrs: [1, 2, 5, 10, 15, 30, 45, 60, 90] };
    const wide = (u, values, index, cycle) => {
      if (cycle > 1) return u.axes[index]._size;
      u.ctx.font = font.replace("12px", 12 * devicePixelRatio + "px");
      return Math.ceil(20 + Math.max(0, ...(values ?? []).map(v => u.ctx.measureText(v).width)) / devicePixelRatio);
    };
    const columns = aligned(spec.series), first = columns[0][0], last = columns[0].at(-1);
    const value = (u, v) => v == null ? "–" : in_words(v, 5);
    const directed = (u, v) => value(u, v == null ? v : degree(v));
    const read = spec.y_direction ? directed : value;
    return plot(spec.id, {
      scales: {
        x: { time: false, distr: spec.x_log ? 3 : 1, range: (u, low, high) => window(low, high) },
        y: { distr: spec.y_log ? 3 : 1, range: u => range_of(spec.y_log, heights(u)) },
      },
      axes: [axis(spec.x_label, Object.assign(spec.x_direction ? round : ticks(spec.x_log), { space: 60 })), axis(spec.y_label, Object.assign(spec.y_direction ? round : ticks(spec.y_log), { size: wide }))],
      legend: { markers: { stroke: (u, i) => `var(--${palette[spec.series[i - 1].colour % palette.length]})`, fill: () => "transparent" } },
      cursor: { y: false, points: { size: 6 }, dataIdx: nearest },
      series: [{ label: spec.x_label, value: spec.x_direction ? directed : value }, ...spec.series.map((s, k) => s.mark == "points"
        ? line(s.label, stroke[k], { value: read, width: 0, paths: () => null, points: { show: true, size: 7, width: 1.6, stroke: stroke[k], fill: colour("paper") } })
        : line(s.label, stroke[k], { value: read, spanGaps: false, dash: s.dashed ? [6, 4] : [], ...(s.mark == "steps" ? { paths: uPlot.paths.stepped({ align: 1 }) } : {}) }))],
      hooks: {
        drawClear: [...spec.upright.map(r => upright_band(r.low, r.high, soft)),
                    ...spec.level.map(r => band(r.low ?? r.at, r.high ?? r.at, soft)),
                    ...spec.series.map((s, k) => errors(s, k + 1, stroke[k]))],
        draw: [uprights(spec.upright.map(r => [r.at, ink, [4, 4], r.label])), levels(spec.level)],
      },
    }, columns);
  };

  // The names of level lines, written above them.
  const levels = rules => u => inside(u, c => {
    c.fillStyle = ink();
    for (const r of rules)
      letter(c, r.label, u.bbox.left + u.bbox.width - 5 * devicePixelRatio, u.valToPos(r.high ?? r.at, "y", true) - 5 * devicePixelRatio, "right");
  });

  // Where a series has nothing under the cursor, what it has next to it within 20 pixels.
  const nearest = (u, k, i, x) => {
    const column = u.data[k], at = u.data[0];
    if (k == 0 || column[i] != null) return i;
    let low = i, high = i;
    while (low >= 0 && column[low] == null) --low;
    while (high < column.length && column[high] == null) ++high;
    const away = j => j < 0 || j >= column.length ? Infinity : Math.abs(u.valToPos(at[j], "x") - u.valToPos(x, "x"));
    const best = away(low) <= away(high) ? low : high;
    return away(best) <= 20 ? best : i;
  };

  const drawAll = specs => specs.map(draw);
  return { ink, soft, grid, truth, found, faint, pale, digits, degree, axis, line, uprights, band, plot, drawAll };
})();
