'use strict';
/* Figures: their list, their estimates at a point, and their formatting. */

const equalPsnr = 150; // dB; above this a mean includes pictures without any difference
const minus = '\u2212', infinitySign = '\u221e', plusMinus = '\u2009\u00b1\u2009';

/** Parses a number. JSON has no infinity, so it arrives as a word. */
function number(value) {
  return value === null || value === undefined ? NaN
    : value === 'inf' ? Infinity : value === '-inf' ? -Infinity : Number(value);
}

function withoutEqual(value, unit) {
  return unit === 'dB' && value >= equalPsnr ? Infinity : value;
}

/** {mean, half, count} of a metric at a point; NaN: unknown. */
function estimate(index, metric) {
  const given = points[index].estimates && metric >= 0 ? points[index].estimates[metric] : null;
  if (!given)
    return {mean: NaN, half: NaN, count: 0};
  const [mean, half, count] = given.map(number);
  const shown = withoutEqual(mean, sweep.metrics[metric].unit);
  return {mean: shown, half: Number.isFinite(shown) ? half : NaN, count};
}

const known = sweep.metrics.map((metric, i) => i).filter(m => done.some(i => !Number.isNaN(estimate(i, m).mean)));

function findMetric(name) {
  const index = sweep.metrics.findIndex(metric => metric.name === name);
  return known.includes(index) ? index : -1;
}

function firstOf(names) {
  return names.map(findMetric).find(m => m >= 0);
}

const telling = ['resident_bytes_peak', 'flip_mean', 'psnr_mean_db', 'psnr_lowest_db', 'ssim_mean', 'gpu_ms_median',
  'host_ms_median', 'frame_ms_median', 'levels_too_coarse', 'time', 'bytes_read', 'loaded_bytes', 'missing_pixels_percent',
  'frames_until_sharp_p99', 'loaded_per_needed', 'wrong_evictions_percent', 'core_us_per_frame', 'requests'];

/** Returns whether a figure is equal in all runs, and so independent of the settings. */
function isConstant(metric) {
  return done.every(i => estimate(i, metric).mean === estimate(done[0], metric).mean);
}

/** Lists at most `count` figures: the most telling ones, then others that differ between runs. */
function tellingMetrics(count) {
  const found = telling.map(findMetric).filter(m => m >= 0);
  return [...found, ...known.filter(m => !found.includes(m) && !isConstant(m))].slice(0, count);
}

const binary = [[2 ** 40, 'TiB'], [2 ** 30, 'GiB'], [2 ** 20, 'MiB'], [2 ** 10, 'KiB'], [1, 'B']];

/** [divisor, unit] in which values up to `most` are written; `most` may be infinite. */
function scaleOf(unit, most) {
  if (unit === 'bytes')
    return binary.find(([size]) => most >= size) || [1, 'B'];
  if (['dB', '%', 'ms', 's'].includes(unit) || !(most >= 1e5) || most === Infinity)
    return [1, unit];
  return most >= 2e6 ? [1e6, `million ${unit}`.trim()] : [1e3, `thousand ${unit}`.trim()];
}

/** About `digits` significant digits, no more letters than needed. */
function digits(value, count) {
  if (Number.isNaN(value))
    return '\u2013';
  if (!Number.isFinite(value))
    return (value < 0 ? minus : '') + infinitySign;
  const size = Math.abs(value);
  let text;
  if (size >= 10 ** count)
    text = Math.round(value).toLocaleString('en').replace(/,/g, '\u2009');
  else
    text = String(Number(value.toPrecision(count)));
  return text.replace('-', minus);
}

function withUnit(text, unit) {
  return unit ? `${text}\u00a0${unit}` : text;
}

function formatValue(value, unit, count = 3) {
  const [divisor, shown] = scaleOf(unit, Math.abs(value));
  return Number.isNaN(value) ? digits(value, count) : withUnit(digits(value / divisor, count), shown);
}

/** Formats a mean with as many digits as its half width justifies. */
function formatEstimate(e, unit) {
  if (!Number.isFinite(e.mean) || !(e.half > 0))
    return [formatValue(e.mean, unit, 4), ''];
  const [divisor, shown] = scaleOf(unit, Math.abs(e.mean));
  const half = e.half / divisor, mean = e.mean / divisor;
  const count = mean === 0 ? 2 : Math.ceil(Math.log10(Math.abs(mean) / half)) + 1;
  return [withUnit(digits(mean, Math.min(Math.max(count, 2), 5)), shown), plusMinus + digits(half, 2)];
}

function estimateText(index, metric) {
  return formatEstimate(estimate(index, metric), sweep.metrics[metric].unit).join('');
}

/**
 * {change, noise} against the base. Compares repeat by repeat if possible: influences that both share,
 * such as a seed or a slow hour, cancel out. Otherwise compares the means.
 */
function changeOf(index, metric) {
  const given = points[index].deltas ? points[index].deltas[metric].map(number) : [NaN, NaN];
  if (Number.isFinite(given[0]) && !Number.isNaN(given[1]))
    return {change: given[0], noise: given[1]};
  const mine = estimate(index, metric), usual = estimate(base, metric);
  return {change: mine.mean - usual.mean, noise: Math.hypot(mine.half || 0, usual.half || 0)};
}

/** {text, kind}: how a point's figure differs from the base's; kind is better, worse, same or ''. */
function compare(index, metric) {
  const {unit, better} = sweep.metrics[metric];
  if (base < 0 || index === base)
    return {text: '', kind: ''};
  const mine = estimate(index, metric), usual = estimate(base, metric);
  if (mine.mean === usual.mean)
    return {text: 'same', kind: 'same'};
  if (Number.isNaN(mine.mean - usual.mean))
    return {text: '\u2013', kind: 'same'};
  if (!Number.isFinite(mine.mean - usual.mean))
    return {text: mine.mean === Infinity ? `now ${infinitySign}` : `was ${infinitySign}`, kind: (mine.mean < usual.mean) === (better === 'less') ? 'better' : 'worse'};
  const {change, noise} = changeOf(index, metric);
  if (Math.abs(change) <= noise)
    return {text: '\u2248 same', kind: 'same'};
  const relative = unit !== 'dB' && unit !== '%' && usual.mean !== 0;
  const sign = change < 0 ? minus : '+', size = Math.abs(change);
  const ratio = mine.mean / usual.mean;
  const text = !relative ? sign + (unit === '%' ? withUnit(digits(size, 2), 'points') : formatValue(size, unit, 2))
    : ratio >= 3 ? `\u00d7\u2009${digits(ratio, 2)}` : sign + withUnit(digits(100 * size / Math.abs(usual.mean), 2), '%');
  /* Fewer than three measured times are too noisy to judge. */
  const doubtful = ['s', 'ms', 'us', 'ns'].includes(unit) && Math.min(mine.count, usual.count) < 3;
  return {text, kind: better === 'neither' || doubtful ? '' : (change < 0) === (better === 'less') ? 'better' : 'worse'};
}

const titles = {psnr: 'PSNR', flip: 'FLIP', ssim: 'SSIM', gpu: 'GPU', p50: 'p50', p95: 'p95', p99: 'p99'};

/** "resident bytes peak": a name as words, without the unit that stands beside it anyway. */
function asWords(name, unit) {
  const words = name.split('_').filter(word => word !== '');
  const said = {dB: 'db', '%': 'percent'}[unit];
  const kept = words.filter(word => word !== said).map(word => word === unit && ['ms', 'us'].includes(word) ? 'time' : word);
  return (kept.length > 0 ? kept : words).map(word => titles[word] || word).join(' ');
}

function metricName(metric) {
  return asWords(sweep.metrics[metric].name, sweep.metrics[metric].unit);
}

function metricTitle(metric) {
  const {unit} = sweep.metrics[metric];
  return unit && unit !== 'bytes' ? `${metricName(metric)} (${unit})` : metricName(metric);
}

/** Rows of name, value and difference to the base. */
function figureTable(index, metrics) {
  return html('table', {class: 'figures'}, html('tbody', {}, metrics.map(metric => {
    const [value, half] = formatEstimate(estimate(index, metric), sweep.metrics[metric].unit);
    const change = compare(index, metric);
    return html('tr', {title: sweep.metrics[metric].meaning},
      html('th', {scope: 'row'}, metricName(metric)),
      html('td', {}, value, html('span', {class: 'pm'}, half)),
      index === base ? null : html('td', {class: change.kind}, change.text));
  })));
}

/** The settings that differ from the base, as options. */
function optionList(index) {
  const d = differences(index);
  return html('ul', {class: 'options', 'aria-label': 'settings'}, d.length === 0
    ? html('li', {class: 'plain'}, 'the base settings')
    : d.map(i => html('li', {}, `--${sweep.settings[i].name} ${points[index].values[i]}`)));
}
