"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const { ink, truth, found, faint, pale, digits, degree, axis, line, uprights, band, plot, drawAll } = tumblePlots;

  // The charge lies across 3 o'clock: the axis begins where there is least of it.
  const start = data.occupancy.start;
  const turned = v => v == null ? null : start + degree(v - start);
  const angles = data.occupancy.truth.map((_, i) => start + i + 0.5);
  const from_start = row => angles.map(a => row[Math.floor(degree(a))]);
  plot("plot-occupancy", {
    scales: { x: { time: false }, y: { range: (u, low, high) => [0, Math.max(high * 1.05, 0.1)] } },
    axes: [axis("angle, degrees", { values: (u, ticks) => ticks.map(t => degree(t)), incrs: [1, 2, 5, 10, 15, 30, 45, 60, 90] }), axis("occupancy")],
    series: [{ label: "angle", value: (u, v) => v == null ? "–" : degree(v).toFixed(1) + "°" },
             line("simulation", truth, { fill: faint(truth), value: digits(3) }), line("film", found, { value: digits(3) })],
    hooks: { draw: [uprights([[turned(data.toe[0]), truth, []], [turned(data.shoulder[0]), truth, []],
                              [turned(data.toe[1]), found, [4, 4]], [turned(data.shoulder[1]), found, [4, 4]]])] },
  }, [angles, from_start(data.occupancy.truth), from_start(data.occupancy.film)]);

  const per_frame = (id, key) => plot(id, {
    scales: { x: { time: false } },
    axes: [axis("time, s"), axis("degrees", { size: 54 })],
    series: [{ label: "time", value: digits(3) }, line("simulation", pale(truth), { width: 3, value: digits(2) }), line("film", found, { width: 1.2, value: digits(2) })],
  }, uPlot.join([[data.truth.time, data.truth[key]], [data.film.time, data.film[key]]]));
  const timed = [per_frame("plot-toe", "toe"), per_frame("plot-shoulder", "shoulder")];

  // A running mean over one lifter's passage, for the eye: single frames jump with single impacts.
  const smooth = (time, values, width) => {
    const out = [];
    let sum = 0, low = 0, high = 0;
    for (const t of time) {
      while (high < time.length && time[high] <= t + width / 2) sum += values[high++] ?? 0;
      while (time[low] < t - width / 2) sum -= values[low++] ?? 0;
      out.push(sum / (high - low));
    }
    return out;
  };
  const [mean, error] = data.torque.mean, passage = data.torque.passage;
  timed.push(plot("plot-torque", {
    scales: { x: { time: false } },
    axes: [axis("time, s"), axis("torque, N m", { size: 54 })],
    series: [{ label: "time", value: digits(3) }, line("each frame", pale(truth), { width: 0.7, value: digits(3) }),
             line("over one lifter’s passage", ink, { value: digits(3) })],
    hooks: { drawClear: [band(mean == null ? null : mean - error, mean + error, found)] },
  }, [data.torque.time, data.torque.torque, smooth(data.torque.time, data.torque.torque, passage)]));

  drawAll(data.plots);

  // Where the film is now, in the plots over time.
  const film = document.querySelector("video"), span = data.film_seconds;
  if (film && span > 0) {
    const heads = timed.filter(u => u).map(u => {
      const head = document.createElement("div");
      head.className = "playhead";
      u.over.appendChild(head);
      return [u, head];
    });
    const follow = () => {
      if (!(film.duration > 0)) return;
      const t = film.currentTime / film.duration * span;
      for (const [u, head] of heads) {
        const at = u.valToPos(t, "x");
        head.style.transform = `translateX(${at}px)`;
        head.hidden = at < 0 || at > u.over.clientWidth;
      }
      if (!film.paused) requestAnimationFrame(follow);
    };
    for (const event of ["play", "seeked", "loadedmetadata"]) film.addEventListener(event, follow);
  }
  // Some browsers want a film in pieces, which a data: address cannot give; a blob can.
  if (film) film.addEventListener("error", async () => {
    if (!film.src.startsWith("data:")) return;
    const bytes = Uint8Array.from(atob(film.src.split(",")[1]), c => c.charCodeAt(0));
    film.src = URL.createObjectURL(new Blob([bytes], { type: "video/mp4" }));
  });
})();
