'use strict';
/* Header, recommended settings, and panel of the chosen run. */

function showHead() {
  document.title = `${sweep.title}: trade-offs`;
  byId('title').textContent = sweep.title;
  byId('scene').textContent = sweep.scene;
  byId('machine').textContent = sweep.machine;
  const failed = points.filter(point => point.state === 'failed'), pending = points.filter(point => point.state === 'pending');
  const runs = done.reduce((sum, i) => sum + Math.max(1, ...points[i].estimates.map(e => e[2])), 0);
  const counts = [['combinations of settings', points.length], ['runs that count', runs], ['settings varied', sweep.settings.filter((s, i) => points.some(p => p.values[i] !== points[0].values[i])).length],
    ['figures', known.length], ['failed', failed.length], ['not run yet', pending.length]];
  byId('counts').append(...counts.filter(([name, value]) => value > 0).map(([name, value]) =>
    html('div', {}, html('dt', {}, name), html('dd', {}, digits(value, 4)))));
  byId('repeat').append(html('div', {class: 'muted small'}, 'This command repeats it:'), commandLine(sweep.command_line, 'the command line of the sweep'));
  if (failed.length > 0)
    byId('failed').append(html('details', {class: 'note', open: failed.length < 6},
      html('summary', {}, failed.length === 1 ? 'One combination failed' : `${failed.length} combinations failed`),
      html('ul', {}, failed.map(point => html('li', {}, html('b', {}, point.label || 'base'), `: ${point.reason || 'no reason is known'}`)))));
}

/** Uses the system's theme until the user chooses one. Prints are light. */
function showTheme() {
  const root = document.documentElement;
  let before;
  window.addEventListener('beforeprint', () => { before = root.dataset.theme; root.dataset.theme = 'light'; });
  window.addEventListener('afterprint', () => {
    if (before)
      root.dataset.theme = before;
    else
      delete root.dataset.theme;
  });
  byId('theme').addEventListener('click', () => {
    const dark = root.dataset.theme ? root.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
    root.dataset.theme = dark ? 'light' : 'dark';
  });
}

function card(recommendation) {
  const index = recommendation.point, there = index >= 0 && points[index] && points[index].state === 'done';
  if (!there)
    return html('article', {class: 'card'}, html('h3', {}, recommendation.name), html('p', {class: 'rule'}, recommendation.rule),
      html('p', {class: 'muted'}, 'No run keeps to this rule.'));
  const show = html('button', {type: 'button', onclick: () => { choose(index); byId('fronts').scrollIntoView(); }}, 'show this run');
  return html('article', {class: 'card'}, html('h3', {}, recommendation.name), html('p', {class: 'rule'}, recommendation.rule),
    optionList(index), html('div', {class: 'foot'}, copyButton(points[index].command_line, 'copy command line', `copy the command line of ${recommendation.name}`), show));
}

/** Shows the figures of the base and of the recommended runs side by side. */
function recommendationTable() {
  const shown = sweep.recommendations.filter(r => r.point >= 0 && points[r.point] && points[r.point].state === 'done');
  const columns = [...(base >= 0 ? [['base', base]] : []), ...shown.map(r => [r.name, r.point])];
  const cell = (index, metric) => {
    const [value, half] = formatEstimate(estimate(index, metric), sweep.metrics[metric].unit), change = compare(index, metric);
    return html('td', {}, value, html('span', {class: 'pm'}, half), html('div', {class: `change ${change.kind}`}, change.text));
  };
  return html('table', {class: 'compared'},
    html('thead', {}, html('tr', {}, html('th', {scope: 'col'}, 'figure'), columns.map(([name]) => html('th', {scope: 'col'}, name)))),
    html('tbody', {}, tellingMetrics(10).map(metric => html('tr', {title: sweep.metrics[metric].meaning},
      html('th', {scope: 'row'}, metricName(metric)), columns.map(([name, index]) => cell(index, metric))))));
}

function showRecommendations() {
  byId('cards').append(...(sweep.recommendations.length > 0 ? sweep.recommendations.map(card) : [html('p', {class: 'muted'}, 'There are none.')]));
  if (base >= 0)
    byId('cards-table').append(recommendationTable());
  else
    byId('cards-table').append(html('p', {class: 'muted'}, 'There are no figures of the base, so there is nothing to compare with.'));
}

function showChosen() {
  const panel = byId('chosen');
  onChosen(index => {
    const select = html('select', {'aria-label': 'chosen run', onchange: event => choose(Number(event.target.value))});
    selectFrom(select, pointEntries(done), index);
    panel.replaceChildren(html('h3', {id: 'chosen-title'}, 'Chosen run'), select, optionList(index), figureTable(index, tellingMetrics(10)),
      copyButton(points[index].command_line, 'copy command line', 'copy the command line of the chosen run'));
  });
}
