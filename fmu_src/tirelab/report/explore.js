"use strict";
// The interactive views of a report: force and residual, over time and over the deflection. They share one window in
// time and one in deflection, the recordings shown, and one marked sample.
(function () {
  const root = document.getElementById("explore");
  const told = document.getElementById("explore-data");
  if (!root || !told || typeof uPlot !== "function") return;
  const source = JSON.parse(told.textContent);

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const channel = (packed) => Float64Array.from(new Uint16Array(bytes(packed.data)), (v) => packed.low + v * packed.step);
  const recordings = source.recordings.map((r) => ({
    name: r.name, used: r.used, thinned: r.thinned, time: new Float32Array(bytes(r.time)),
    x: channel(r.deflection), force: channel(r.force), before: channel(r.before), after: channel(r.after),
  }));

  const SERIES = source.alike ? ["recorded", "before"] : ["recorded", "before", "after"];
  const LABEL = { recorded: "recorded", before: source.alike ? "simulated" : "before", after: "after" };
  const shown = recordings.map(() => true);
  const drawn = { recorded: true, before: true, after: true };
  const range = { time: null, x: null };
  let all = null;
  let marked = -1;

  const VIEWS = [
    { id: "force-time", axis: "time", residual: false },
    { id: "force-x", axis: "x", residual: false },
    { id: "residual-time", axis: "time", residual: true },
    { id: "residual-x", axis: "x", residual: true },
  ];
  const number = (v, digits) => v.toFixed(digits).replace("-", "−");
  // As in the other pictures: no marks between thousands, a real minus sign.
  const ticks = (u, values) => values.map((v) => v === null ? "" : String(Number(v.toPrecision(9))).replace(/-/g, "−"));

  // --- what is shown -------------------------------------------------------------------------------------------
  function assemble() {
    const chosen = recordings.filter((_, i) => shown[i]);
    const size = chosen.reduce((n, r) => n + r.time.length, 0);
    const make = () => new Float64Array(size);
    all = { size, time: make(), x: make(), force: make(), before: make(), after: make(), owner: [], starts: [] };
    let at = 0, start = 0;
    for (const r of chosen) {
      all.starts.push(at);
      for (let i = 0; i < r.time.length; i++, at++) {
        all.time[at] = start + r.time[i];
        all.x[at] = r.x[i];
        all.force[at] = r.force[i];
        all.before[at] = r.before[i];
        all.after[at] = r.after[i];
      }
      all.owner.push({ recording: r, from: at - r.time.length, to: at, start });
      start = all.time[at - 1] + (r.time.length > 1 ? r.time[r.time.length - 1] / (r.time.length - 1) : 1);
    }
    all.full = { time: extent(all.time), x: extent(all.x) };
  }
  function extent(values) {
    let low = Infinity, high = -Infinity;
    for (const v of values) { if (v < low) low = v; if (v > high) high = v; }
    return low < high ? [low, high] : low === high ? [low - 1, high + 1] : [0, 1];
  }
  const limits = (axis) => range[axis] || all.full[axis];
  function inWindow(i) {
    const t = range.time, x = range.x;
    return (!t || (all.time[i] >= t[0] && all.time[i] <= t[1])) && (!x || (all.x[i] >= x[0] && all.x[i] <= x[1]));
  }
  const ownerOf = (i) => all.owner.find((o) => i >= o.from && i < o.to);
  function value(view, series, i) {
    if (!view.residual) return series === "recorded" ? all.force[i] : all[series][i];
    return all.force[i] - all[series][i];
  }
  const seriesOf = (view) => SERIES.filter((s) => drawn[s] && !(view.residual && s === "recorded"));
  function heights(view) {
    let low = Infinity, high = -Infinity;
    const chosen = seriesOf(view);
    for (let i = 0; i < all.size; i++) {
      if (!inWindow(i)) continue;
      for (const s of chosen) {
        const v = value(view, s, i);
        if (v < low) low = v;
        if (v > high) high = v;
      }
    }
    if (view.residual) { low = Math.min(low, -1.5 * source.noise); high = Math.max(high, 1.5 * source.noise); }
    if (!(low < high)) return low === high ? [low - 1, high + 1] : [-1, 1];
    const room = 0.05 * (high - low);
    return [low - room, high + room];
  }

  // --- drawing --------------------------------------------------------------------------------------------------
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  function band(u, view) {
    const ctx = u.ctx, top = u.valToPos(source.noise, "y", true), low = u.valToPos(-source.noise, "y", true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    if (view.residual) { ctx.fillStyle = colour("band"); ctx.fillRect(u.bbox.left, top, u.bbox.width, low - top); }
    ctx.restore();
  }
  function loop(u, view) {
    const ctx = u.ctx, dot = Math.max(devicePixelRatio, 1) * 1.6;
    const [x0, x1] = limits("x"), sx = u.bbox.width / (x1 - x0);
    const [y0, y1] = view.heights, sy = u.bbox.height / (y1 - y0);
    const px = (v) => u.bbox.left + (v - x0) * sx, py = (v) => u.bbox.top + u.bbox.height - (v - y0) * sy;
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    // One dot for each pixel: most of 100 000 samples fall on one that has its dot.
    const wide = Math.ceil(u.bbox.width) + 9, taken = new Uint8Array(wide * (Math.ceil(u.bbox.height) + 9));
    let turn = 0;
    for (const s of seriesOf(view)) {
      turn++;
      ctx.fillStyle = ctx.strokeStyle = colour(s);
      ctx.lineWidth = 1.2 * devicePixelRatio;
      for (const o of all.owner) {
        if (s !== "recorded" && !view.residual && !o.recording.thinned && o.to - o.from < 4000) {
          ctx.beginPath();
          for (let i = o.from, down = false; i < o.to; i++) {
            const inside = inWindow(i);
            if (inside) { if (down) ctx.lineTo(px(all.x[i]), py(value(view, s, i))); else ctx.moveTo(px(all.x[i]), py(value(view, s, i))); }
            down = inside;
          }
          ctx.stroke();
        } else {
          for (let i = o.from; i < o.to; i++) {
            if (!inWindow(i)) continue;
            const left = Math.round(px(all.x[i])), top = Math.round(py(value(view, s, i)));
            const cell = (top - (u.bbox.top | 0) + 4) * wide + left - (u.bbox.left | 0) + 4;
            if (taken[cell] === turn) continue;
            taken[cell] = turn;
            ctx.fillRect(left - dot / 2, top - dot / 2, dot, dot);
          }
        }
      }
    }
    ctx.restore();
  }
  function columns(view) {
    if (view.axis === "x") return [limits("x"), [null, null]];
    return [all.time, ...seriesOf(view).map((s) => {
      const column = new Array(all.size);
      for (let i = 0; i < all.size; i++) column[i] = inWindow(i) ? value(view, s, i) : null;
      return column;
    })];
  }
  function options(view) {
    const ink = colour("ink"), line = { stroke: colour("grid"), width: 1 };
    const axis = (label) => ({ label, stroke: ink, grid: line, ticks: line, values: ticks, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 18, labelGap: 2 });
    const lines = view.axis === "x" ? [{}] : seriesOf(view).map((s) => ({ label: LABEL[s], stroke: colour(s), width: 1.1, points: { show: false }, spanGaps: false }));
    return {
      width: view.box.clientWidth || 400, height: 240, legend: { show: false },
      cursor: { points: { show: false }, drag: { x: true, y: false, setScale: false }, focus: { prox: -1 } },
      scales: { x: { time: false, auto: false, range: () => limits(view.axis) }, y: { auto: false, range: () => view.heights } },
      series: [{}, ...lines],
      axes: [
        { ...axis(view.axis === "time" ? (all.owner.length > 1 ? "time, recordings one after another [s]" : "time [s]") : "deflection [mm]"), size: 34 },
        { ...axis(view.residual ? "residual [N]" : "force [N]"), size: 48 },
      ],
      hooks: {
        drawClear: [(u) => band(u, view)],
        draw: [(u) => { if (view.axis === "x") loop(u, view); }],
        setSelect: [(u) => {
          if (u.select.width < 4) return;
          const low = u.posToVal(u.select.left, "x"), high = u.posToVal(u.select.left + u.select.width, "x");
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          zoomTo(view.axis, low, high);
        }],
      },
    };
  }
  function draw() {
    for (const view of VIEWS) {
      view.heights = heights(view);
      if (view.plot) view.plot.destroy();
      view.plot = new uPlot(options(view), columns(view), view.box);
      view.rings = seriesOf(view).map((s) => {
        const ring = document.createElement("div");
        ring.className = "ring " + s;
        ring.hidden = true;
        view.plot.over.appendChild(ring);
        return [s, ring];
      });
      view.plot.over.addEventListener("mousemove", (e) => hover(view, e));
      const [low, high] = limits(view.axis);
      view.box.dataset.from = low;
      view.box.dataset.to = high;
    }
    mark(marked >= 0 && marked < all.size && inWindow(marked) ? marked : -1);
    root.querySelector("[data-do=reset]").disabled = !range.time && !range.x;
  }

  // --- one marked sample in all views ---------------------------------------------------------------------------
  function hover(view, e) {
    if (e.buttons || view.waiting) return;  // a drag chooses a window
    view.waiting = true;
    requestAnimationFrame(() => { view.waiting = false; mark(nearest(view, e.offsetX, e.offsetY)); });
  }
  function nearest(view, left, top) {
    const u = view.plot, chosen = seriesOf(view)[0];
    if (!chosen) return -1;
    const width = u.over.clientWidth, height = u.over.clientHeight;
    const [x0, x1] = limits(view.axis), [y0, y1] = view.heights;
    let best = -1, least = Infinity;
    for (let i = 0; i < all.size; i++) {
      if (!inWindow(i)) continue;
      const dx = ((view.axis === "time" ? all.time[i] : all.x[i]) - x0) / (x1 - x0) * width - left;
      const dy = view.axis === "time" ? 0 : (y1 - value(view, chosen, i)) / (y1 - y0) * height - top;
      const away = dx * dx + dy * dy;
      if (away < least) { least = away; best = i; }
    }
    return best;
  }
  function mark(i) {
    marked = i;
    for (const view of VIEWS) {
      for (const [s, ring] of view.rings) {
        ring.hidden = i < 0;
        if (i < 0) continue;
        const left = view.plot.valToPos(view.axis === "time" ? all.time[i] : all.x[i], "x");
        const top = view.plot.valToPos(value(view, s, i), "y");
        ring.style.transform = `translate(${left}px, ${top}px)`;
      }
    }
    const out = document.getElementById("explore-readout");
    if (i < 0) { out.textContent = "Point at a plot, or focus it and press an arrow key."; return; }
    const o = ownerOf(i), parts = [`recorded ${number(all.force[i], 1)} N`];
    for (const s of SERIES.slice(1)) parts.push(`${LABEL[s]} ${number(all[s][i], 1)} N (residual ${number(all.force[i] - all[s][i], 1)} N)`);
    out.textContent = `${o.recording.name}: ${number(all.time[i] - o.start, 3)} s, ${number(all.x[i], 2)} mm; ${parts.join(", ")}`;
  }

  // --- window ---------------------------------------------------------------------------------------------------
  function zoomTo(axis, low, high) {
    const [from, to] = all.full[axis];
    const least = (to - from) * 1e-4;
    low = Math.max(low, from);
    high = Math.min(high, to);
    if (high - low < least) return;
    range[axis] = low <= from && high >= to ? null : [low, high];
    draw();
  }
  function zoom(axis, factor, about) {
    const [low, high] = limits(axis);
    const middle = about === undefined ? (low + high) / 2 : about;
    zoomTo(axis, middle - (middle - low) * factor, middle + (high - middle) * factor);
  }
  function pan(axis, part) {
    const [low, high] = limits(axis), [from, to] = all.full[axis];
    const step = Math.min(Math.max(part * (high - low), from - low), to - high);
    zoomTo(axis, low + step, high + step);
  }
  function reset() { range.time = range.x = null; draw(); }
  function step(by) {
    let i = marked < 0 ? (by > 0 ? -1 : all.size) : marked;
    do i += by; while (i >= 0 && i < all.size && !inWindow(i));
    if (i >= 0 && i < all.size) mark(i);
  }

  // --- controls -------------------------------------------------------------------------------------------------
  function toggle(text, on, changed) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = on;
    box.addEventListener("change", () => changed(box));
    label.append(box, document.createElement("bdi"));
    label.lastChild.textContent = text;
    return label;
  }
  const toggles = root.querySelector(".toggles");
  for (const s of SERIES) {
    const label = toggle(LABEL[s], true, (box) => { drawn[s] = box.checked; if (all) draw(); });
    label.className = s;
    toggles.append(label);
  }
  if (recordings.length > 1) {
    recordings.forEach((r, i) => root.querySelector(".recordings").append(
      toggle(`${r.name} (${r.used})`, true, (box) => {
        shown[i] = box.checked;
        if (!shown.some(Boolean)) { shown[i] = box.checked = true; return; }
        if (!all) return;
        marked = -1;
        range.time = null;
        assemble();
        draw();
      })));
  } else root.querySelector(".recordings").remove();
  const DO = {
    in: () => zoom("time", 0.5), out: () => zoom("time", 2), left: () => pan("time", -0.25), right: () => pan("time", 0.25), reset,
  };
  for (const button of root.querySelectorAll("[data-do]")) button.addEventListener("click", () => all && DO[button.dataset.do]());

  for (const view of VIEWS) {
    view.box = document.getElementById("explore-" + view.id);
    view.box.addEventListener("keydown", (e) => {
      if (!view.plot) return;
      const sign = e.key === "ArrowRight" ? 1 : e.key === "ArrowLeft" ? -1 : 0;
      if (sign && e.shiftKey) pan(view.axis, 0.1 * sign);
      else if (sign) step(sign * (e.altKey ? 100 : 1));
      else if (e.key === "+" || e.key === "=") zoom(view.axis, 0.5, at(view));
      else if (e.key === "-") zoom(view.axis, 2, at(view));
      else if (e.key === "Home" || e.key === "0" || e.key === "Escape") reset();
      else return;
      e.preventDefault();
    });
    view.box.addEventListener("wheel", (e) => {
      if (!e.ctrlKey && !e.metaKey) return;
      e.preventDefault();
      const over = view.plot.over.getBoundingClientRect();
      zoom(view.axis, e.deltaY < 0 ? 0.8 : 1.25, view.plot.posToVal(e.clientX - over.left, "x"));
    }, { passive: false });
    view.box.addEventListener("mousedown", (e) => {
      if (!e.shiftKey || !view.plot.over.contains(e.target)) return;
      e.stopPropagation();
      e.preventDefault();
      let from = e.clientX;
      const width = view.plot.over.clientWidth;
      const move = (m) => { pan(view.axis, (from - m.clientX) / width); from = m.clientX; };
      const up = () => { document.removeEventListener("mousemove", move); document.removeEventListener("mouseup", up); };
      document.addEventListener("mousemove", move);
      document.addEventListener("mouseup", up);
    }, true);
    view.box.addEventListener("dblclick", reset);
  }
  function at(view) { return marked < 0 ? undefined : view.axis === "time" ? all.time[marked] : all.x[marked]; }

  function start() {
    assemble();
    draw();
    new ResizeObserver(() => {
      for (const view of VIEWS) {
        if (view.box.clientWidth && Math.abs(view.box.clientWidth - view.plot.width) > 1) { draw(); return; }
      }
    }).observe(root);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
    root.dataset.ready = Math.round(performance.now());
  }
  // The first screen is painted before the plots are made.
  root.hidden = false;
  addEventListener("load", () => requestAnimationFrame(() => setTimeout(start)));
})();
