'use strict';
/* Figures over the frames of two runs, one over the other. */

const columnKinds = [['psnr_db', 'dB'], ['flip', ''], ['ssim', ''], ['missing_pixels_percent', '%'], ['missing_levels', 'levels'],
  ['resident_tiles', 'tiles'], ['needed_tiles', 'tiles'], ['tiles_mapped', 'tiles'], ['bytes_read', 'bytes'], ['loads_in_flight', 'loads'],
  ['frame_ms', 'ms'], ['host_ms', 'ms'], ['gpu_ms', 'ms'], ['device_memory', 'bytes']];

const runs = new Map(series.runs.map(run => [run.point, run]));
let frameUnderPointer = -1;

function columnOf(run, name) {
  const column = run && run.columns.find(c => c.name === name);
  return column ? {most: column.most.map(number), least: (column.least || column.most).map(number)} : null;
}

/** Percentage of missing pixels among the sampled ones, whose number changes with the view. */
function missingPercent(run) {
  const missing = columnOf(run, 'missing_pixels'), sampled = columnOf(run, 'sampled_pixels');
  if (!missing || !sampled)
    return null;
  const share = (part, i) => sampled.most[i] > 0 ? Math.min(100, 100 * part / sampled.most[i]) : NaN;
  return {most: missing.most.map(share), least: missing.least.map(share)};
}

function seriesOf(point, name) {
  const run = runs.get(point);
  const column = name === 'missing_pixels_percent' ? columnOf(run, name) || missingPercent(run) : columnOf(run, name);
  if (!column || column.most.every(Number.isNaN))
    return null;
  const unit = name.endsWith('_db') ? 'dB' : '';
  return {point, step: run.step, frames: run.frames, most: column.most.map(v => withoutEqual(v, unit)), least: column.least.map(v => withoutEqual(v, unit))};
}

function columnNames(all) {
  const first = columnKinds.map(kind => kind[0]);
  const there = [...new Set([...runs.values()].flatMap(run => run.columns.map(c => c.name)))];
  return all ? [...first, ...there.filter(name => !first.includes(name) && name !== 'at_rest')] : first;
}

function columnUnit(name) {
  const kind = columnKinds.find(k => k[0] === name);
  return kind ? kind[1] : name.startsWith('bytes') ? 'bytes' : name.endsWith('_ms') ? 'ms' : '';
}

/** Marks the frames with a camera at rest, if the run has that column. */
function drawRest(point, along, box) {
  const rest = columnOf(runs.get(point), 'at_rest');
  const first = rest ? rest.most.findIndex(v => v > 0) : -1;
  if (first < 0)
    return null;
  const x = along(first * runs.get(point).step);
  return svg('g', {'aria-hidden': 'true'}, svg('rect', {class: 'rest', x, y: box.top, width: Math.max(0, box.right - x), height: box.bottom - box.top}),
    svg('text', {class: 'hint', x: box.right - 4, y: box.bottom - 5, 'text-anchor': 'end'}, 'at rest'));
}

function drawLine(data, kind, along, scale) {
  const at = (values, i) => [along(i * data.step + (data.step - 1) / 2), scale.place(values[i])];
  const middle = data.most.map((v, i) => at(data.most, i)), known = middle.filter(p => !Number.isNaN(p[1]));
  if (known.length * 2 < middle.length) // measured in every few frames only: dots, and a line through them
    return [svg('path', {class: `line thin ${kind}`, d: path(known)}), ...known.map(p => svg('circle', {class: `dot ${kind}`, cx: p[0], cy: p[1], r: 2.5}))];
  if (data.step === 1)
    return [svg('path', {class: `line ${kind}`, d: path(middle)})];
  const least = data.least.map((v, i) => at(data.least, i)), clean = points => points.filter(p => !Number.isNaN(p[1]));
  return [svg('path', {class: `area ${kind}`, d: path([...clean(middle), ...clean(least).reverse()]) + 'Z'}),
    svg('path', {class: `line ${kind}`, d: path(middle.map((p, i) => [p[0], (p[1] + least[i][1]) / 2]))})];
}

const crosses = [];

function moveCross(frame) {
  frameUnderPointer = frame;
  crosses.forEach(cross => cross());
}

function valueAt(data, unit) {
  const bin = Math.floor(frameUnderPointer / data.step);
  if (bin >= data.most.length)
    return '\u2013';
  const most = formatValue(data.most[bin], unit), least = formatValue(data.least[bin], unit);
  return most === least ? most : `${least} to ${most}`;
}

/** The line under the pointer, in all plots at once, and the figures of its frame. */
function addCross(root, box, along, frames, now, shown, unit, usual) {
  const line = svg('line', {class: 'cross', y1: box.top, y2: box.bottom, visibility: 'hidden'});
  root.append(line);
  crosses.push(() => {
    const inside = frameUnderPointer >= 0 && frameUnderPointer < frames;
    line.setAttribute('visibility', inside ? 'visible' : 'hidden');
    if (inside) {
      line.setAttribute('x1', along(frameUnderPointer));
      line.setAttribute('x2', along(frameUnderPointer));
    }
    now.textContent = inside ? `frame ${frameUnderPointer}: ${shown.map(d => valueAt(d, unit)).join(' | ')}` : usual;
  });
  root.addEventListener('pointermove', event => {
    const area = root.getBoundingClientRect(), x = (event.clientX - area.left) * root.viewBox.baseVal.width / area.width;
    moveCross(Math.max(0, Math.min(frames - 1, Math.round((x - box.left) / (box.right - box.left) * Math.max(1, frames - 1)))));
  });
  root.addEventListener('pointerleave', () => moveCross(-1));
}

function drawColumn(name, a, b) {
  const shown = [...new Set([a, b])].map(point => seriesOf(point, name)).filter(Boolean);
  if (shown.length === 0)
    return;
  const unit = columnUnit(name), holder = html('div', {class: 'multiple'});
  byId('series-plots').append(holder);
  const frames = Math.max(...shown.map(d => d.frames)), {width, root} = canvas(holder, 150, `${asWords(name, unit)} over ${frames} frames`);
  const box = {left: 44, right: width - 6, top: 8, bottom: 128};
  const scale = makeScale(shown.flatMap(d => [...d.most, ...d.least]), unit, box.bottom, box.top, {count: 4, logFrom: unit === 'ms' ? 300 : Infinity, zero: unit !== 'dB' && name !== 'ssim'});
  const along = frame => box.left + frame / Math.max(1, frames - 1) * (box.right - box.left);
  const ticks = linearTicks(0, frames - 1, width < 300 ? 3 : 5).filter(t => Number.isInteger(t)).map(t => ({at: along(t), text: digits(t, 5)}));
  const usual = [scale.unit, scale.log ? 'logarithmic' : ''].filter(Boolean).join(', ');
  const now = html('span', {class: 'now'}, usual);
  root.append(...[drawRest(a, along, box)].filter(Boolean), drawXAxis({ticks}, box, null), drawYAxis(scale, box, null),
    ...[...shown].reverse().flatMap(d => drawLine(d, d.point === a ? 'a' : 'b', along, scale)));
  addCross(root, box, along, frames, now, shown, unit, usual);
  holder.append(html('h4', {}, asWords(name, unit), now), root);
}

function drawSeries() {
  const a = Number(byId('series-a').value), b = Number(byId('series-b').value);
  crosses.length = 0;
  byId('series-plots').replaceChildren();
  columnNames(byId('series-all').checked).forEach(name => drawColumn(name, a, b));
  const steps = [...new Set([a, b])].filter(p => runs.has(p)).map(p => runs.get(p).step).filter(step => step > 1);
  byId('series-note').textContent = steps.length > 0 ? `${steps.join(' and ')} frames are one step here: the band is from the least to the most of them.` : '';
}

function showMissingSeries() {
  const why = new Map();
  series.left_out.forEach(gone => why.set(gone.why, [...(why.get(gone.why) || []), pointName(gone.point)]));
  const told = names => names.length > 6 ? `${names.slice(0, 6).join('; ')} and ${names.length - 6} more` : names.join('; ');
  byId('series-missing').textContent = [...why].map(([reason, names]) => `Without figures over frames (${reason}): ${told(names)}.`).join(' ');
}

function showSeries() {
  showMissingSeries();
  if (runs.size === 0) {
    byId('series-plots').append(html('p', {class: 'muted'}, 'No run has figures over its frames on this page.'));
    return;
  }
  const entries = pointEntries([...runs.keys()].sort((p, q) => p - q)), start = runs.has(base) ? base : entries[0][0];
  selectFrom(byId('series-a'), entries, start);
  selectFrom(byId('series-b'), entries, start);
  ['series-a', 'series-b', 'series-all'].forEach(id => byId(id).addEventListener('change', drawSeries));
  drawSeries();
  onChosen(index => {
    if (!runs.has(index)) {
      byId('series-note').textContent = `The chosen run, ${pointName(index)}, has no figures over frames on this page.`;
      return;
    }
    byId('series-a').value = index;
    drawSeries();
  });
  onResize(drawSeries);
}
