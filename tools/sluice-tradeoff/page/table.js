'use strict';
/* Table of all points, which can be sorted, and its CSV. */

const table = {by: null, down: false};

function tableMetrics() {
  return byId('table-all').checked ? known : tellingMetrics(7);
}

function sortKey(index) {
  if (table.by === 'label')
    return pointName(index);
  return table.by === null ? index : estimate(index, table.by).mean;
}

/** Filters and sorts the points. Unknown values come last in either direction. */
function sortedPoints() {
  const wanted = byId('table-filter').value.trim().toLowerCase();
  const text = i => `${pointName(i)} ${points[i].command_line} ${points[i].reason || ''} ${roles(i).join(' ')}`.toLowerCase();
  const shown = points.map((point, i) => i).filter(i => text(i).includes(wanted)), sign = table.down ? -1 : 1;
  const unknown = i => typeof sortKey(i) === 'number' && Number.isNaN(sortKey(i));
  return shown.sort((a, b) => {
    if (unknown(a) || unknown(b))
      return unknown(a) - unknown(b) || a - b;
    const [p, q] = [sortKey(a), sortKey(b)];
    return (typeof p === 'string' ? p.localeCompare(q, 'en', {numeric: true}) : p < q ? -1 : p > q ? 1 : 0) * sign || a - b;
  });
}

function headCell(key, text, meaning) {
  const sorted = table.by === key, arrow = sorted ? (table.down ? ' \u2193' : ' \u2191') : '';
  return html('th', {scope: 'col', title: meaning, 'aria-sort': sorted ? (table.down ? 'descending' : 'ascending') : null},
    html('button', {type: 'button', onclick: () => {
      table.down = sorted ? !table.down : typeof key === 'number' && sweep.metrics[key].better === 'more';
      table.by = key;
      drawTable();
    }}, text + arrow));
}

function row(index, metrics) {
  const point = points[index], tags = roles(index).filter(name => name !== pointName(index)).map(name => html('span', {class: 'tag'}, name));
  const name = point.state === 'done'
    ? html('button', {type: 'button', class: 'link', title: point.command_line, onclick: () => choose(index)}, pointName(index)) : pointName(index);
  const cells = point.state === 'done'
    ? metrics.map(m => {
      const [value, half] = formatEstimate(estimate(index, m), sweep.metrics[m].unit);
      return html('td', {}, value, html('span', {class: 'pm'}, half));
    })
    : [html('td', {colspan: metrics.length, class: point.state === 'failed' ? 'worse' : 'muted'}, point.state === 'failed' ? `failed: ${point.reason || 'no reason is known'}` : 'not run yet')];
  return html('tr', {class: index === chosen ? 'is-chosen' : null}, html('td', {}, String(index + 1)), html('td', {}, name, tags), cells,
    html('td', {}, copyButton(point.command_line, 'copy', `copy the command line of ${pointName(index)}`)));
}

function drawTable() {
  const metrics = tableMetrics(), shown = sortedPoints();
  byId('table').replaceChildren(
    html('thead', {}, html('tr', {}, headCell(null, '#', 'in the order of the sweep'), headCell('label', 'settings that differ', ''),
      metrics.map(m => headCell(m, metricName(m), sweep.metrics[m].meaning)), html('th', {scope: 'col'}, html('span', {class: 'hidden'}, 'command line')))),
    html('tbody', {}, shown.map(index => row(index, metrics))));
  byId('table-text').textContent = `${shown.length} of ${points.length} combinations; ${metrics.length} of ${known.length} figures.`;
}

/** Quotes a cell. A value that a spreadsheet would read as a formula gets an apostrophe in front. */
function csvCell(value) {
  const text = String(value);
  const safe = /^[=+@\t]/.test(text) || /^-[^\d.]/.test(text) ? `'${text}` : text;
  return /[",\n\r]/.test(safe) ? `"${safe.replace(/"/g, '""')}"` : safe;
}

function csvText() {
  const head = ['point', 'state', ...sweep.settings.map(s => s.name), ...known.flatMap(m => [sweep.metrics[m].name, `${sweep.metrics[m].name}_half_width`]), 'repeats', 'command_line', 'reason'];
  const finite = value => value === null ? '' : value;
  const rows = points.map((point, i) => [i + 1, point.state, ...point.values,
    ...known.flatMap(m => point.estimates ? point.estimates[m].slice(0, 2).map(finite) : ['', '']),
    point.estimates ? Math.max(0, ...point.estimates.map(e => e[2])) : 0, point.command_line, point.reason || '']);
  return [head, ...rows].map(cells => cells.map(csvCell).join(',')).join('\n') + '\n';
}

function showTable() {
  byId('table-filter').addEventListener('input', drawTable);
  byId('table-all').addEventListener('change', drawTable);
  byId('csv-copy').addEventListener('click', event => copyText(csvText(), event.target));
  byId('csv-save').addEventListener('click', event => {
    event.target.href = URL.createObjectURL(new Blob([csvText()], {type: 'text/csv'}));
  });
  drawTable();
  onChosen(drawTable);
}
