// SPDX-License-Identifier: GPL-3.0-or-later
// The charts of the errors of an implant, of the seeds found on images, of the same implant under other choices, and of
// the dose while the gland swells.
import { element } from '../../../shared/dom';
import { numberText } from '../../../shared/numbers';
import { INK, PALE, SOFT } from '../../../shared/plot_style';
import type { Triple } from '../dose/data';
import { build } from '../page_part';
import { buildBars } from '../plots/bars';
import { Chart } from '../plots/chart';
import { buildLines } from '../plots/lines';
import { addLegend, type Look, type Series } from '../plots/series';
import { extent } from '../plots/ticks';
import { capital, type Choice, type ImplantData, type Oedema, type Seed } from './data';

const BLUE = '#0072b2';
const ORANGE = '#c44601';
const AXES = [
  { caption: 'Left and right', toward: 'left', against: 'right', to: 'the ' },
  { caption: 'Posterior and anterior', toward: 'posterior', against: 'anterior', to: '' },
  { caption: 'Superior and inferior', toward: 'superior', against: 'inferior', to: '' },
];
const MARKS = ['disc', 'square', 'triangle'] as const;

/** A number with its sign; zero has none. */
function signed(value: number, digits: number): string {
  const text = numberText(value, digits);
  return Number(value.toFixed(digits)) > 0 ? `+${text}` : text;
}

/** A signed length with its direction instead of a sign: "1.2 mm to inferior". */
function towardText(mm: number, axis: number): string {
  const { toward, against, to } = AXES[axis];
  return `${Math.abs(mm).toFixed(1)} mm to ${to}${mm < 0 ? against : toward}`;
}

const errorOf = (at: Triple, planned: Triple) => at.map((mm, axis) => mm - planned[axis]) as Triple;

/** A figure with its caption for each axis of the patient. */
function threeFigures(box: HTMLElement, buildOne: (plot: HTMLElement, axis: number) => string): void {
  AXES.forEach(({ caption }, axis) => {
    const figure = element('figure');
    const plot = element('div', 'plot');
    figure.append(element('figcaption', '', caption), plot);
    box.append(figure);
    figure.firstElementChild?.append(element('span', '', buildOne(plot, axis)));
  });
}

/** The legend of the marks of the thirds, with their numbers of seeds. */
function addThirds(box: HTMLElement, { seeds, thirds }: ImplantData): void {
  const looks = thirds.map(({ name, color }, k): Look & { count: number } => {
    const count = seeds.filter(({ third }) => third === k).length;
    return { label: `${name} (${count})`, color, shape: 'none', mark: MARKS[k], count };
  });
  addLegend(box, looks.filter(({ count }) => count > 0));
}

/** A series of marks for each third. @param at the place of a seed's mark @param open whether it is not filled */
function marksOf<Kind extends { third: number }>({ thirds }: ImplantData, seeds: Kind[], at: (seed: Kind) => [number, number], open: (seed: Kind) => boolean): { series: Series[]; seedAt: (series: Series, index: number) => Kind } {
  const groups = thirds.map((_, third) => seeds.filter((seed) => seed.third === third));
  const series = thirds.map(({ name, color }, third): Series => {
    const places = groups[third].map(at);
    return { label: name, color, shape: 'none', mark: MARKS[third], x: places.map(([x]) => x), y: places.map(([, y]) => y), open: (i) => open(groups[third][i]) };
  });
  return { series, seedAt: (one, index) => groups[series.indexOf(one)][index] };
}

/** The signed error of each seed over its planned position from inferior to superior, for each axis. */
function buildErrors(box: HTMLElement, data: ImplantData): void {
  const { nouns } = data;
  const seeds = data.seeds.flatMap((seed) => (seed.rest_mm ? [{ ...seed, error: errorOf(seed.rest_mm, seed.planned_mm) }] : []));
  if (seeds.length === 0) {
    box.replaceChildren(element('p', 'note', `No ${nouns.source} is left in the patient.`));
    return;
  }
  // Single seeds far from the others do not decide the scale.
  const limit = 2 * data.error.p95_mm;
  const all = seeds.flatMap(({ error }) => error);
  const [low, high] = extent([[0, 0.5], all.map((mm) => Math.max(-limit, Math.min(limit, mm)))], 0.04);
  const shown = (mm: number) => Math.max(low, Math.min(high, mm));
  threeFigures(box, (plot, axis) => {
    const { toward, against } = AXES[axis];
    const { series, seedAt } = marksOf(data, seeds, (seed) => [seed.planned_mm[2], shown(seed.error[axis])], (seed) => shown(seed.error[axis]) !== seed.error[axis]);
    new Chart(plot, {
      x: { label: 'Planned position, inferior to superior [mm]', range: extent([data.seeds.map((seed) => seed.planned_mm[2])], 0.04) },
      y: { label: `← ${against} · Error [mm] · ${toward} →`, range: [low, high] },
      rules: [{ y: 0, color: PALE }],
      series,
      pick: 'point',
      tell: ({ series: one, index }) => {
        const { number, needle, error } = seedAt(one, index);
        return [[`${capital(nouns.source)} ${number}, ${nouns.needle} ${needle}`], [towardText(error[axis], axis)]];
      },
    });
    return '';
  });
  const beyond = seeds.filter(({ error }) => error.some((mm) => shown(mm) !== mm)).length;
  if (beyond > 0) {
    box.after(element('p', 'note', `Open marks at the edge stand for errors beyond the scale; ${beyond} ${beyond === 1 ? `${nouns.source} has` : `${nouns.sources} have`} such one. The table of ${nouns.sources} has them.`));
  }
}

/** The causes of the errors: mean size and mean along each axis. */
function buildCauses(box: HTMLElement, { causes, error }: ImplantData): void {
  if (causes.length === 0) return;
  const together = { name: 'all causes together', mean_mm: error.mean_mm, mean_xyz_mm: [error.x_mm.mean, error.y_mm.mean, error.z_mm.mean] };
  buildBars(box, 'Mean error [mm]', [...causes, together].map(({ name, mean_mm: size, mean_xyz_mm: mean }) => ({
    name,
    bars: [
      { name: 'mean size', value: size, text: size.toFixed(2), color: SOFT },
      ...mean.map((mm, axis) => ({ name: AXES[axis].toward, value: mm, text: signed(mm, 2), color: BLUE })),
    ],
  })));
}

const EQUAL: Look = { label: 'found as simulated', color: SOFT, width: 1.8 };
const SHIFTED: Look = { label: 'moved by the common shift', color: ORANGE, width: 1.8, dashes: [7, 5] };

/** The error of each matched seed as it was found over the simulated one, for each axis, all with the same scale. */
function buildScatters(box: HTMLElement, data: ImplantData): void {
  const { found, seeds } = data;
  if (!found) return;
  const byNumber = new Map(seeds.map((seed) => [seed.number, seed]));
  const matched = found.seeds.map((seed) => ({
    ...seed, third: (byNumber.get(seed.number) as Seed).third,
    simulated: errorOf(seed.rest_mm, seed.planned_mm), error: errorOf(seed.found_mm, seed.planned_mm),
  }));
  const range = extent([[0, 0.5], matched.flatMap(({ simulated, error }) => [...simulated, ...error])], 0.04);
  threeFigures(box, (plot, axis) => {
    const { toward } = AXES[axis];
    const { series, seedAt } = marksOf(data, matched, ({ simulated, error }) => [simulated[axis], error[axis]], ({ ambiguous }) => ambiguous);
    const shift = found.common_shift_mm[axis];
    new Chart(plot, {
      x: { label: `Simulated error [mm] · ${toward} →`, range },
      y: { label: `Found error [mm] · ${toward} →`, range },
      rules: [{ x: 0, color: PALE }, { y: 0, color: PALE }],
      series: [{ ...EQUAL, x: range, y: range }, { ...SHIFTED, x: range, y: range.map((mm) => mm + shift) }, ...series],
      follow: series,
      pick: 'point',
      tell: ({ series: one, index }) => {
        const { number, needle, simulated, error, ambiguous } = seedAt(one, index);
        return [[`Seed ${number}, needle ${needle}${ambiguous ? ' (ambiguous match)' : ''}`],
          ['simulated', towardText(simulated[axis], axis)], ['found', towardText(error[axis], axis)]];
      },
    });
    const { correlation } = found.agreement['xyz'[axis] as 'x' | 'y' | 'z'];
    return correlation === null ? '' : `correlation ${numberText(correlation, 2)}`;
  });
}

/** The parts of the mean square of the errors found, with the common shift and without it. */
function buildParts(box: HTMLElement, { found }: ImplantData): void {
  const NOTHING_MM2 = 5e-4;  // parts below it are left out, as by their two decimals
  if (!found) return;
  const groups = found.as_found.parts.map((part) => ({ part, without: found.without_shift.parts.find(({ cause }) => cause === part.cause) }))
    .filter(({ part, without }) => Math.max(Math.abs(part.mm2), Math.abs(without?.mm2 ?? 0)) > NOTHING_MM2);
  if (groups.length === 0) return;
  const text = ({ mm2, percent }: { mm2: number; percent: number }) => `${signed(mm2, 2)} (${signed(percent, 0)} %)`;
  buildBars(box, 'Part of the mean square error [mm²]', groups.map(({ part, without }) => ({
    name: part.cause,
    bars: [
      { name: 'as found', value: part.mm2, text: text(part), color: SOFT },
      { name: 'without common shift', value: without?.mm2 ?? null, text: without ? text(without) : 'taken away', color: BLUE },
    ],
  })));
}

const OF_TWO = [{ color: '#b5179e', dashes: [7, 5] }, { color: BLUE, dashes: [] }];
const OF_THREE = [OF_TWO[0], { color: INK, dashes: [] }, { color: BLUE, dashes: [2, 4] }];

/** The share of the seeds that rest within a distance from their planned place, under each choice. */
function buildDistances(box: HTMLElement, { nouns }: ImplantData, choices: Choice[]): void {
  const all = [0, ...choices.flatMap((choice) => choice.distances_mm)].sort((a, b) => a - b);
  const most = all[all.length - 1];
  if (!(most > 0)) return;
  const x = [...all, 1.04 * most];
  const series = choices.map(({ name, distances_mm: mm }, k): Series => ({
    ...(choices.length === 2 ? OF_TWO : OF_THREE)[k], label: name, shape: 'steps', width: 2.5, x,
    y: x.map((reach) => (100 * mm.filter((distance) => distance <= reach).length) / mm.length),
  }));
  const legend = element('div', 'legend');
  addLegend(legend, series);
  box.before(legend);
  new Chart(box, {
    x: { label: 'Distance from the planned place [mm]', range: [0, 1.04 * most], tell: (mm) => `within ${mm.toFixed(2)} mm` },
    y: { label: `${capital(nouns.sources)} within it [%]`, range: [0, 102], tell: (percent) => `${percent.toFixed(0)} %` },
    series,
  });
}

/** Width of the gland, D90 so far, and what the swelling takes away from it, over the days since the implant. */
function buildOedema(box: HTMLElement, oedema: Oedema): void {
  const { days: x, swelling_percent: widths, D90_Gy: with_Gy, D90_without_swelling_Gy: without_Gy } = oedema;
  const taken = without_Gy.map((Gy, k) => Gy - with_Gy[k]);
  const [inTheEnd, without, lost] = oedema.in_the_end_Gy;
  const gray = (Gy: number) => `${numberText(Gy, 1)} Gy`;
  const alike = widths.slice(1).every((width) => width.every((percent, k) => percent === widths[0][k]));
  const directions = ['right to left', 'anterior to posterior', 'inferior to superior'];
  const parts: { title: string; series: Omit<Series, 'x'>[]; tell(value: number): string }[] = [
    {
      title: 'Width of the gland beyond its width without swelling [%]',
      series: widths.slice(0, alike ? 1 : 3).map((y, k) => ({
        y, label: alike ? 'in each direction' : directions[k], color: BLUE, dashes: [[], [7, 4], [2, 4]][k],
      })),
      tell: (percent) => `${signed(percent, 1)} %`,
    },
    {
      title: 'D90 of the target so far [Gy]',
      series: [
        { y: with_Gy, label: `with swelling: ${inTheEnd.toFixed(0)} Gy in the end`, color: BLUE },
        { y: without_Gy, label: `without: ${without.toFixed(0)} Gy in the end`, color: SOFT, dashes: [7, 4] },
      ],
      tell: gray,
    },
    {
      title: `${lost < 0 ? 'Added to' : 'Taken away from'} D90 by the swelling so far [Gy]`,
      series: [{ y: taken.map(Math.abs), label: `${Math.abs(lost).toFixed(1)} Gy in the end`, color: BLUE }],
      tell: gray,
    },
  ];
  const names = parts.flatMap(({ series }) => series.map(({ label }) => label));
  parts.forEach(({ title, series, tell }, k) => {
    const figure = element('figure');
    const plot = element('div', 'plot');
    plot.setAttribute('aria-label', `${title} over the days since the implant`);
    figure.append(element('figcaption', '', title), plot);
    box.append(figure);
    buildLines(plot, {
      x: { label: k < 2 ? '' : 'Days since the implant', tell: (day) => `day ${day.toFixed(0)}` },
      y: { label: '', tell }, names, rules: [{ y: 0, color: PALE }], series: series.map((one) => ({ ...one, x })),
    });
  });
}

export function buildImplantCharts(data: ImplantData): void {
  const { found, oedema } = data;
  build('third-key', (box) => addThirds(box, data));
  build('error-charts', (box) => buildErrors(box, data));
  build('cause-chart', (box) => buildCauses(box, data));
  if (found && found.seeds.length > 0) {
    build('found-key', (box) => {
      addThirds(box, data);
      addLegend(box, [EQUAL, SHIFTED]);
    });
    build('found-charts', (box) => buildScatters(box, data));
    build('found-parts', (box) => buildParts(box, data));
  }
  for (const [id, choices] of Object.entries(data.choices)) build(`${id}-chart`, (box) => buildDistances(box, data, choices));
  if (oedema) build('oedema-charts', (box) => buildOedema(box, oedema));
}
