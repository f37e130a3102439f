'use strict';
/* Effect of each setting alone: plots figures over its values, with all other settings as in the base. */

/** A setting's value as a number: "16", "1/16"; NaN for words. */
function settingNumber(text) {
  const parts = /^([-+]?[\d.]+(?:e[-+]?\d+)?)(?:\/(\d+))?$/i.exec(text.trim());
  return parts ? Number(parts[1]) / (parts[2] ? Number(parts[2]) : 1) : NaN;
}

/** Returns whether 0 means no limit for a setting, and so sorts above all numbers. */
function zeroIsAll(setting) {
  return /\b0: (no|any|all|as many)\b/.test(sweep.settings[setting].meaning);
}

/** [{index, text, value}] of the runs that differ from the base in this setting alone, and the base. */
function alone(setting) {
  const rows = done.filter(i => i === sweep.base || groupOf(i) === setting)
    .map(index => ({index, text: points[index].values[setting], value: settingNumber(points[index].values[setting])}))
    .map(row => row.value === 0 && zeroIsAll(setting) ? {...row, value: Infinity} : row);
  const numeric = rows.every(row => !Number.isNaN(row.value));
  rows.sort((a, b) => numeric ? a.value - b.value : (a.index === sweep.base ? -1 : b.index === sweep.base ? 1 : a.index - b.index));
  return {rows, numeric};
}

/** Spaces values evenly. Numbers of one magnitude are placed to scale instead. */
function alongX({rows, numeric}, left, right) {
  const values = rows.map(row => row.value), finite = values.filter(Number.isFinite), low = Math.min(...finite), high = Math.max(...finite);
  if (numeric && values.includes(Infinity) && finite.length > 0) { // infinity: at the end, behind a gap
    const others = alongX({rows: rows.slice(0, finite.length), numeric}, left, right - (right - left) / 4);
    return i => values[i] === Infinity ? right : others(i);
  }
  const even = i => left + (rows.length > 1 ? i / (rows.length - 1) : 0.5) * (right - left);
  if (!numeric || low === high)
    return even;
  if (low > 0 && high / low >= 8)
    return i => left + Math.log(values[i] / low) / Math.log(high / low) * (right - left);
  return low <= 0 && high > 16 ? even : i => left + (values[i] - low) / (high - low) * (right - left);
}

function drawBand(rows, xs, metric, scale, color) {
  const edges = rows.map((row, i) => ({e: estimate(row.index, metric), x: xs[i]})).filter(p => Number.isFinite(p.e.mean));
  if (!edges.some(p => p.e.half > 0))
    return null;
  const edge = sign => edges.map(p => [p.x, scale.place(p.e.mean + sign * (p.e.half > 0 ? p.e.half : 0))]);
  return svg('path', {class: 'band', fill: color, d: path([...edge(1), ...edge(-1).reverse()]) + 'Z'});
}

function drawWhisker(row, x, metric, scale, color) {
  const e = estimate(row.index, metric);
  return e.half > 0 && Number.isFinite(e.mean)
    ? svg('line', {class: 'bar', stroke: color, x1: x, x2: x, y1: scale.place(e.mean - e.half), y2: scale.place(e.mean + e.half)}) : null;
}

/** Draws labels of the values, except where they would overlap the previous label. */
function drawValues(rows, xs, y) {
  let free = -Infinity;
  return rows.map((row, i) => {
    const half = Math.min(row.text.length, 9) * 3.1;
    if (xs[i] - half < free)
      return null;
    free = xs[i] + half + 3;
    return svg('text', {x: xs[i], y, 'text-anchor': 'middle'}, row.text === '' ? 'unset' : row.text.length > 9 ? `${row.text.slice(0, 8)}\u2026` : row.text);
  });
}

function effectRange(metric, settings) {
  return extentOf(settings.flatMap(setting => alone(setting).rows).map(row => estimate(row.index, metric)));
}

function drawEffect(place, setting, metric, range) {
  const {rows, numeric} = alone(setting), unit = sweep.metrics[metric].unit, color = groupColor(setting);
  const {width, root} = canvas(place, 128, `${metricName(metric)} for ${sweep.settings[setting].name}: ` +
    rows.map(row => `${row.text}: ${estimateText(row.index, metric)}`).join(', '));
  const box = {left: 42, right: width - 6, top: 22, bottom: 108};
  const scale = makeScale(range, unit, box.bottom, box.top, {count: 3, logFrom: 60});
  const at = alongX({rows, numeric}, box.left + 14, box.right - 14), xs = rows.map((row, i) => at(i));
  root.append(drawYAxis(scale, box, axisTitle(metricName(metric), scale)), ...drawValues(rows, xs, box.bottom + 16).filter(Boolean));
  const line = rows.map((row, i) => [xs[i], scale.place(estimate(row.index, metric).mean)]);
  if (numeric)
    root.append(...[drawBand(rows, xs, metric, scale, color), svg('path', {class: 'line', stroke: color, d: path(line)})].filter(Boolean));
  else
    root.append(...rows.map((row, i) => drawWhisker(row, xs[i], metric, scale, color)).filter(Boolean));
  rows.forEach((row, i) => {
    if (Number.isNaN(line[i][1]))
      return;
    root.append(svg('path', {class: 'mark', d: groupShape(setting, 4.5), fill: color, transform: `translate(${line[i][0]} ${line[i][1]})`,
      onclick: () => choose(row.index), onpointerleave: hideTip,
      onpointerenter: event => showTip(event.clientX, event.clientY, [`--${sweep.settings[setting].name} ${row.text}`, `${metricName(metric)}: ${estimateText(row.index, metric)}`, compare(row.index, metric).text])}));
    if (row.index === sweep.base)
      root.append(svg('circle', {class: 'ring', r: 7.5, cx: line[i][0], cy: line[i][1]}));
  });
  place.append(root);
}

/* Metrics in groups of memory, picture, time and traffic; the first known one of each group. */
const effectGroups = [['resident_bytes_peak', 'device_memory_peak'], ['flip_mean', 'psnr_mean_db', 'psnr_lowest_db', 'levels_too_coarse'],
  ['gpu_ms_median', 'frame_ms_median', 'time', 'core_us_per_frame'], ['bytes_read', 'loaded_bytes', 'frames_until_sharp_p99']].map(firstOf).filter(m => m !== undefined);
const effectMetrics = new Set(effectGroups.length > 0 ? effectGroups : tellingMetrics(4));

function drawEffects() {
  const settings = varied.filter(setting => alone(setting).rows.length > 1), oneScale = byId('effect-scale').checked;
  const metrics = known.filter(m => effectMetrics.has(m));
  const ranges = new Map(metrics.map(m => [m, oneScale ? effectRange(m, settings) : null]));
  byId('effect-plots').replaceChildren();
  for (const setting of settings) {
    const {name, meaning, unit} = sweep.settings[setting], places = metrics.map(() => html('div', {}));
    byId('effect-plots').append(html('div', {class: 'effect'},
      html('div', {}, html('h4', {}, `--${name}`), html('p', {class: 'muted'}, unit ? `${meaning} (${unit})` : meaning)), html('div', {class: 'row'}, places)));
    metrics.forEach((metric, k) => drawEffect(places[k], setting, metric, ranges.get(metric) || effectRange(metric, [setting])));
  }
  const others = sweep.settings.filter((s, i) => !settings.includes(i)).map(s => s.name);
  byId('effect-none').textContent = others.length > 0 ? `Not varied alone: ${others.join(', ')}.` : '';
}

function showEffects() {
  byId('effect-metrics').append(...known.map(m => html('label', {title: sweep.metrics[m].meaning}, html('input', {type: 'checkbox', checked: effectMetrics.has(m), onchange: event => {
    effectMetrics[event.target.checked ? 'add' : 'delete'](m);
    drawEffects();
  }}), metricName(m))));
  byId('effect-scale').addEventListener('change', drawEffects);
  drawEffects();
  onResize(drawEffects);
}
