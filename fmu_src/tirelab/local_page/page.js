"use strict";
// The local page: everything that came from outside is set as text, never as HTML.
(function () {
  const $ = (id) => document.getElementById(id);
  const make = (tag, text, attributes) => {
    const e = document.createElement(tag);
    if (text !== undefined) e.textContent = text;
    for (const [name, value] of Object.entries(attributes || {})) e.setAttribute(name, value);
    return e;
  };
  // Part of the whole time that is spent when each stage begins, as in the command line.
  const SHARES = [["reading", 0.01], ["comparing", 0.06], ["fitting", 0.19], ["validating", 0.6], ["searching", 0.67], ["building", 0.87], ["replaying", 0.9], ["writing", 0.93]];
  // What stands on the page by its number: as it was told, and its article.
  const shown = { recordings: new Map(), diagnoses: new Map() };
  // What was asked for last: an older answer would take back what was chosen since.
  let timer = 0, told = "", asked = 0;

  async function ask(path, options) {
    const answer = await fetch(path, options);
    const content = await answer.json();
    if (!answer.ok) throw new Error(content.problem || answer.statusText);
    return content;
  }
  function say(problem) { $("problem").textContent = problem; $("problem").hidden = !problem; }
  function wait(text) { $("waiting").textContent = text; $("waiting").hidden = !text; }
  async function attempt(work) {
    asked += 1;
    try { say(""); await work(); } catch (error) { say(error.message); }
    await refresh();
  }

  async function send(files) {
    const problems = [];
    for (const file of files) {
      wait(`reading ${file.name} ...`);
      try { await ask(`recordings?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file }); }
      catch (error) { problems.push(error.message); }
      wait("");
      await refresh();
    }
    $("files").value = "";
    say(problems.join(" · "));
  }

  function recording(r) {
    const box = make("article", undefined, { class: "recording", "data-number": r.number });
    const title = make("h3");
    title.append(make("bdi", r.name));
    box.append(title);
    if (r.problem) box.append(make("p", r.problem, { class: "alarm" }));
    if (r.facts.length) box.append(make("p", r.facts.map(([what, text]) => `${what}: ${text}`).join(" · "), { class: "facts" }));
    for (const doubt of r.doubts) box.append(make("p", `doubtful: ${doubt}`, { class: "alarm" }));
    for (const note of r.notes) box.append(make("p", note, { class: "caption" }));

    const row = make("div", undefined, { class: "row" });
    const label = make("label", "Use: "), use = make("select", undefined, { class: "use" });
    for (const [value, text] of [["fitted", "fit"], ["held-out", "hold out, to check the correction"], ["left out", "leave out"]]) {
      const option = make("option", text, { value });
      option.selected = value === r.use;
      use.append(option);
    }
    use.addEventListener("change", () => attempt(() => ask(`recordings/${r.number}`, { method: "POST", body: JSON.stringify({ use: use.value }) })));
    label.append(use);
    const remove = make("button", "Remove", { type: "button" });
    remove.addEventListener("click", () => attempt(() => ask(`recordings/${r.number}`, { method: "DELETE" })));
    row.append(label, remove);
    box.append(row);

    const details = make("details");
    details.open = Boolean(r.problem);
    details.append(make("summary", "Columns, units and surface"));
    const form = make("form"), table = make("table"), head = make("tr");
    const given = (table, channel) => r.settings[table][channel] || (r.guess[table] || {})[channel] || "";
    for (const text of ["Quantity", "Column", "Unit", "Sign", "Values", "Remark"]) head.append(make("th", text, { scope: "col" }));
    table.append(head);
    const fields = [];
    const channels = r.channels.length ? r.channels : [];
    channels.forEach((c) => {
      const line = make("tr");
      const name = c.channel === "believed_force" ? "force of a simulation" : c.channel;
      line.append(make("th", c.required ? name : `${name} (optional)`, { scope: "row" }));
      const column = make("select", undefined, { "aria-label": `column of ${c.channel}` });
      column.append(make("option", c.column ? `as read: ${c.column}` : r.problem ? "by its name" : "none", { value: "" }));
      const set = given("columns", c.channel), number = set.replace(/^[+-]/, "");
      r.headers.forEach((text, i) => {
        const option = make("option", text, { value: `#${i + 1}` });
        option.selected = number === `#${i + 1}`;
        column.append(option);
      });
      const sign = make("select", undefined, { "aria-label": `sign of ${c.channel}` });
      for (const [value, text] of [["", "as read"], ["+", "keep"], ["-", "reverse"]]) {
        const option = make("option", text, { value });
        option.selected = value !== "" && set.startsWith(value);
        sign.append(option);
      }
      const unit = make("input", undefined, { "aria-label": `unit of ${c.channel}`, size: 8, placeholder: c.unit, value: given("units", c.channel) });
      const cells = [make("td"), make("td"), make("td")];
      cells[0].append(column);
      cells[1].append(unit);
      if (c.channel === "deflection" || c.channel === "force") cells[2].append(sign);
      line.append(...cells, make("td", c.values, { class: "values" }), make("td", c.remark));
      table.append(line);
      fields.push([c.channel, column, unit, sign, `#${r.headers.indexOf(c.column) + 1}`]);
    });
    const surface = make("label", "Surface, where no column has its radius: "), radius = make("input", undefined, { size: 12, placeholder: "flat, 25.4 cm", value: r.settings.radius || r.guess.radius || "" });
    surface.append(radius);
    const scroll = make("div", undefined, { class: "scroll" });
    scroll.append(table);
    form.append(scroll, surface, make("button", "Apply", { type: "submit" }));
    form.addEventListener("submit", (e) => {
      e.preventDefault();
      const columns = {}, units = {};
      for (const [channel, column, unit, sign, read] of fields) {
        const chosen = column.value || (sign.value && read !== "#0" ? read : "");
        if (chosen) columns[channel] = sign.value + chosen;
        if (unit.value.trim()) units[channel] = unit.value.trim();
      }
      const sent = entered(box);
      attempt(async () => {
        await ask(`recordings/${r.number}`, { method: "POST", body: JSON.stringify({ columns, units, radius: radius.value }) });
        box.saved = sent;
      });
    });
    details.append(form);
    box.append(details);
    box.saved = entered(box);
    return box;
  }

  const fieldsOf = (box) => [...box.querySelectorAll("form input, form select")];
  const entered = (box) => fieldsOf(box).map((field) => field.value);
  // Where the focus is within an article: its place among what can have it.
  const CAN_FOCUS = "select, input, button, summary, a";
  const focused = (box) => [...box.querySelectorAll(CAN_FOCUS)].indexOf(document.activeElement);
  // A recording that is read another way now: its new article with the panel, the focus and unsaved fields of the old.
  function renewed(r, old) {
    const box = recording(r), at = focused(old), panel = old.querySelector("details");
    box.querySelector("details").open = panel.open || Boolean(r.problem);
    const now = entered(old);
    fieldsOf(box).forEach((field, i) => { if (now[i] !== old.saved[i]) field.value = now[i]; });
    return [box, () => { const field = box.querySelectorAll(CAN_FOCUS)[at]; if (field) field.focus(); }];
  }
  // Only what changed is replaced, so that nothing entered, opened or focused is lost.
  function place(list, kind, told, key, write) {
    const known = shown[kind], numbers = new Set(told.map((one) => one.number));
    for (const [number, { box }] of known) if (!numbers.has(number)) { box.remove(); known.delete(number); }
    told.forEach((one, i) => {
      const had = known.get(one.number), text = key(one);
      if (!had || had.text !== text) {
        const [box, after] = had && kind === "recordings" ? renewed(one, had.box) : [write(one), () => {}];
        if (had) had.box.replaceWith(box);
        known.set(one.number, { box, text });
        after();
      }
      const { box } = known.get(one.number);
      if (list.children[i] !== box) list.insertBefore(box, list.children[i] || null);
    });
  }

  const TITLES = { "report.html": "Report", "tire.json": "Tire", "BicycleTire.fmu": "FMU", "Correction.fmu": "FMU of the correction", "diagnosis.json": "Numbers", "separating_test.csv": "Drive file", "plots.csv": "Plot data" };
  function diagnosis(d) {
    const box = make("article", undefined, { class: "result", id: `result-${d.number}` });
    box.append(make("h3", d.headline), make("p", d.sure, { class: "caption" }));
    const links = make("ul", undefined, { class: "links" });
    for (const name of d.files) {
      const item = make("li"), link = make("a", TITLES[name] || name, { href: `diagnoses/${d.number}/${name}` });
      if (name === "report.html") link.target = "_blank"; else link.setAttribute("download", name);
      item.append(link);
      links.append(item);
    }
    box.append(links);
    return box;
  }

  async function refresh() {
    const own = asked += 1;
    let state;
    try { state = await ask("state"); } catch (error) { say(`tirelab open no longer answers (${error.message}); start it again.`); return; }
    if (own !== asked) return;
    $("reading").hidden = true;
    $("none").hidden = state.diagnoses.length > 0;
    place($("recordings"), "recordings", state.recordings, (r) => JSON.stringify({ ...r, use: "" }), recording);
    for (const r of state.recordings) shown.recordings.get(r.number).box.querySelector(".use").value = r.use;
    place($("diagnoses"), "diagnoses", [...state.diagnoses].reverse(), JSON.stringify, diagnosis);
    const job = state.job, running = Boolean(job && job.running);
    const fitted = state.recordings.filter((r) => r.use === "fitted"), unread = state.recordings.filter((r) => r.problem && r.use !== "left out");
    $("diagnose").disabled = running || !fitted.length || unread.length > 0;
    $("why").textContent = running ? "" : unread.length ? "Correct how the marked recording is read, or leave it out." : fitted.length ? "" : "Drop a recording first.";
    $("stop").hidden = !running;
    $("progress").hidden = !running;
    if (job) {
      const stage = job.stages[job.stages.length - 1] || "starting";
      const found = SHARES.find(([begin]) => stage.startsWith(begin));
      if (running) $("progress").value = found ? found[1] : 0;
      tell(running ? stage : job.problem || "done", !running && !job.problem ? state.diagnoses.find((d) => d.number === job.number) : null);
      $("stage").className = !running && job.problem ? "alarm" : "";
    }
    clearTimeout(timer);
    if (running) timer = setTimeout(refresh, 500);
  }
  // What the diagnosis does, and in the end the way to its result.
  function tell(text, result) {
    const now = JSON.stringify([text, result ? result.number : 0]);
    if (now === told) return;
    told = now;
    $("stage").textContent = text;
    if (result) $("stage").append(": ", make("a", result.headline, { href: `#result-${result.number}` }));
  }

  $("files").addEventListener("change", () => send($("files").files));
  $("diagnose").addEventListener("click", () => attempt(() => ask("diagnose", { method: "POST", body: "" })));
  $("stop").addEventListener("click", () => attempt(() => ask("diagnose", { method: "DELETE" })));
  for (const kind of ["dragover", "dragenter"]) document.addEventListener(kind, (e) => { e.preventDefault(); $("drop").classList.add("over"); });
  document.addEventListener("dragleave", () => $("drop").classList.remove("over"));
  document.addEventListener("drop", (e) => { e.preventDefault(); $("drop").classList.remove("over"); send(e.dataTransfer.files); });
  $("reading").hidden = false;
  refresh();
})();
