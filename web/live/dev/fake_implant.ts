// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up plan of seeds for work on the page without a server. Its dose is invented.
import type { DroppedSeed, Goal, Implant, Plan, PlanSeed, Seeds } from '../src/implant/implant';
import { holes } from '../src/scene';
import { Kind } from '../src/wire';
import { SKIN_Z, type FakePatient } from './fake_patient';

type Place = [number, number, number];
const LENGTH = 4.5;
const NAMES = ['B4', 'b3.5', 'b4.5', 'C3', 'C4', 'C5', 'D3', 'D5.5', 'E3', 'E4', 'E5', 'e3.5', 'F4'];

export class FakeImplant {
  readonly plan: Plan;
  readonly seeds: DroppedSeed[] = [];

  constructor(patient: FakePatient) {
    const all = patient.text.template ? holes(patient.text.template) : [];
    let number = 0;
    this.plan = {
      current: 0, seed_length_mm: LENGTH, seed_diameter_mm: 0.8, prescription_Gy: 145, source: 'made up', technique: 'pushed',
      needles: NAMES.map((name, k) => {
        const hole = all.find((h) => h.name === name);
        const [x, y] = [hole?.x ?? 0, hole?.y ?? 0];
        const depth = 63;
        const seeds: PlanSeed[] = Array.from({ length: 3 + (k % 3) }, (_, i) => ({
          number: number++, planned_mm: [x, y, SKIN_Z + depth - LENGTH / 2 - 10 * i] as Place, axis: [0, 0, 1] as Place,
          drop_depth_mm: depth - LENGTH - 10 * i,
        }));
        return { name, hole: name, entry_mm: [x, y, SKIN_Z] as Place, direction: [0, 0, 1] as Place, depth_mm: depth, ready: k < 5, seeds };
      }),
    };
  }

  /** @param tip place of the needle's tip @param shift mean motion of the tissue */
  drop(tip: number[], shift: number): string {
    const { needles, current } = this.plan;
    const seed = needles[current]?.seeds[this.seeds.filter((s) => s.needle === current).length];
    if (!seed) return 'All seeds of this needle have been dropped.';
    const dropped: Place = [tip[0], tip[1], tip[2] + LENGTH / 2];
    const rest: Place = [dropped[0], dropped[1], dropped[2] - shift];
    const error = rest.map((x, k) => x - seed.planned_mm[k]);
    this.seeds.push({
      number: seed.number, needle: current, planned_mm: seed.planned_mm, dropped_mm: dropped, rest_mm: rest, axis: [0, 0, 1],
      error_mm: Math.hypot(...error), in_tissue: true,
      why: { hand: [0, 0, error[2] + shift], 'needle bend': [error[0], 0, 0], 'tissue motion': [0, 0, -0.9 * shift], 'tissue relaxation': [0, 0, -0.1 * shift] },
    });
    return '';
  }

  /** All seeds but the last `left` ones, a little off. */
  dropMost(left: number): void {
    this.plan.needles.forEach((needle, k) => {
      this.plan.current = k;
      for (const seed of needle.seeds) {
        const [x, y, z] = seed.planned_mm;
        const off = [0.4 * Math.sin(seed.number), 0.5 * Math.cos(2 * seed.number), 2 * Math.sin(3 * seed.number)];
        this.drop([x + off[0], y + off[1], z - LENGTH / 2 + off[2]], 2.4);
      }
    });
    this.seeds.length -= left;
    this.plan.current = this.plan.needles.length - 1;
  }

  state(): Implant {
    const total = this.plan.needles.reduce((sum, needle) => sum + needle.seeds.length, 0);
    const count = this.seeds.length;
    const errors = this.seeds.map((s) => s.error_mm).sort((a, b) => a - b);
    const mean = (of: (s: DroppedSeed) => number) => (count ? this.seeds.reduce((sum, s) => sum + of(s), 0) / count : 0);
    const goals = (share: number): Goal[] => [
      { structure: 'prostate', metric: 'D90_percent', at_least: true, bound: 100, value: 112 * share, met: 112 * share >= 100 },
      { structure: 'prostate', metric: 'V100_percent', at_least: true, bound: 95, value: 98 * share, met: 98 * share >= 95 },
      { structure: 'urethra', metric: 'D10_percent', at_least: false, bound: 150, value: null, met: false },
      { structure: 'rectum', metric: 'D2cc_percent', at_least: false, bound: 100, value: 71 * share, met: true },
    ];
    const score = (share: number) => ({ seeds: count, d90_Gy: 162 * share, d90_percent: 112 * share, v100_percent: 98 * share, took_ms: 12, goals: goals(share) });
    return {
      planned_seeds: total, train_from_mm: null, seeds: this.seeds, computing: false, now: score((0.94 * count) / total), planned: score(1),
      error: {
        seeds: count, mean_mm: mean((s) => s.error_mm), p95_mm: errors[Math.floor(0.95 * count)] ?? 0, largest_mm: errors[count - 1] ?? 0,
        axes_mm: [0, 1, 2].map((k) => ({ mean: mean((s) => s.rest_mm[k] - s.planned_mm[k]), sd: 1.1 })),
      },
      why: ['hand', 'needle bend', 'tissue motion', 'tissue relaxation'].map((cause) => ({
        cause, meaning: '', mean_mm: mean((s) => Math.hypot(...s.why[cause])), mean_xyz_mm: [0, 0, mean((s) => s.why[cause][2])] as Place,
      })),
    };
  }

  now(shift: number): Seeds {
    return { now_mm: this.seeds.map(({ rest_mm: [x, y, z] }) => [x, y, z + shift]) };
  }

  /** A dose of invented size around each seed, as a message. */
  dose(): ArrayBuffer {
    const [size, spacing, origin] = [[36, 30, 34], 2, [-35, -29, -33]];
    const buffer = new ArrayBuffer(40 + 2 * size[0] * size[1] * size[2]);
    const view = new DataView(buffer);
    view.setUint32(0, Kind.dose, true);
    size.forEach((n, i) => view.setUint32(8 + 4 * i, n, true));
    [...origin, spacing, 0.1].forEach((x, i) => view.setFloat32(20 + 4 * i, x, true));
    const values = new Uint16Array(buffer, 40);
    let at = 0;
    for (let k = 0; k < size[2]; k++) {
      for (let j = 0; j < size[1]; j++) {
        for (let i = 0; i < size[0]; i++) {
          const x = [i, j, k].map((n, axis) => origin[axis] + spacing * n);
          const sum = this.seeds.reduce((all, s) => all + 900 / (6 + x.reduce((r, xx, axis) => r + (xx - s.rest_mm[axis]) ** 2, 0)), 0);
          values[at++] = Math.min(65535, 10 * sum);
        }
      }
    }
    return buffer;
  }
}
