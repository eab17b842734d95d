// SPDX-License-Identifier: GPL-3.0-or-later
// An implant that is carried out needle by needle, as the server describes it, and what follows from it. Lengths are in
// mm, places in LPS.
type Place = [number, number, number];

export interface PlanSeed { number: number; planned_mm: Place; axis: Place; drop_depth_mm: number }
export interface PlanNeedle {
  name: string; hole: string; entry_mm: Place; direction: Place; depth_mm: number; ready: boolean; seeds: PlanSeed[];
}
export interface Plan {
  needles: PlanNeedle[]; current: number; seed_length_mm: number; seed_diameter_mm: number; prescription_Gy: number;
  source: string; technique: 'pushed' | 'preloaded';
}

export interface Goal { structure: string; metric: string; at_least: boolean; bound: number; value: number | null; met: boolean }
export interface Score {
  seeds: number; d90_Gy: number | null; d90_percent: number | null; v100_percent: number | null; took_ms: number; goals: Goal[];
}
export interface DroppedSeed {
  number: number; needle: number; planned_mm: Place; dropped_mm: Place; rest_mm: Place; axis: Place; error_mm: number;
  in_tissue: boolean; lost?: boolean; why: Record<string, Place>;
}
export interface Errors { seeds: number; mean_mm: number; p95_mm: number; largest_mm: number; axes_mm: { mean: number; sd: number }[] }
export interface Cause { cause: string; meaning: string; mean_mm: number | null; mean_xyz_mm: Place }
export interface Tally { skin_punctures: number; organ_entries: number; bone_contacts: number; exits: number }
export interface Implant {
  train_from_mm: number | null;  // a train is being left, begun at this depth of the base
  planned_seeds: number; seeds: DroppedSeed[]; computing: boolean; now: Score | null; planned: Score | null; error: Errors; why: Cause[];
  tally?: Tally;  // of all needles so far
}
export interface Seeds { now_mm: Place[] }

/** The dose around the target, in the tissue at rest. */
export interface Dose {
  size: [number, number, number]; origin: Place; spacing: number;
  unit: number;         // percent of the prescribed dose for each unit of `values`
  values: Uint16Array;  // x varies fastest
}

const BEHIND_TRAIN_MM = 2;        // so far the needle is drawn back beyond its last seed
export const IN_PLACE_MM = 0.5;  // a needle this near to the planned depth of a seed counts as being there

/** The needle of the plan that is in front of or in the patient; null: one beside the plan. */
export function currentNeedle(plan: Plan | null): PlanNeedle | null {
  return plan?.needles[plan.current] ?? null;
}

/** How many seeds of a needle have been dropped. */
export function droppedOf(implant: Implant | null, needle: number): number {
  return implant?.seeds.filter((seed) => seed.needle === needle).length ?? 0;
}

/** The seed that the needle drops next; null: it is empty, or beside the plan. */
export function nextSeed(plan: Plan | null, implant: Implant | null): PlanSeed | null {
  return plan ? currentNeedle(plan)?.seeds[droppedOf(implant, plan.current)] ?? null : null;
}

/** The needle after the present one that still has seeds; −1: all are empty. */
export function nextNeedle(plan: Plan, implant: Implant | null): number {
  const { needles, current } = plan;
  for (let k = 1; k <= needles.length; k++) {
    const needle = (Math.max(-1, current) + k) % needles.length;
    if (droppedOf(implant, needle) < needles[needle].seeds.length) return needle;
  }
  return -1;
}

/** Whether all seeds of the plan have been dropped. */
export function isFinished(implant: Implant | null): boolean {
  return implant !== null && implant.seeds.length > 0 && implant.seeds.length >= implant.planned_seeds;
}

/** The hand's task before the next seed: a sentence, and whether the needle is in place. */
export function whatToDo(plan: Plan, implant: Implant | null, depth: number): { text: string; inPlace: boolean } {
  const needle = currentNeedle(plan);
  if (!needle) return { text: 'This hole is not in the plan. Choose a needle below.', inPlace: false };
  if (isFinished(implant)) return { text: 'All seeds of the plan have been dropped.', inPlace: false };
  const seed = nextSeed(plan, implant);
  if (!seed) return { text: `Needle ${needle.name} is empty. Take the next one.`, inPlace: false };
  const number = needle.seeds.indexOf(seed) + 1;
  if (plan.technique === 'preloaded') return whatToDoWithTrain(needle, number, seed, implant, depth);
  const togo = seed.drop_depth_mm - depth;
  const which = `Needle ${needle.name}, seed ${number} of ${needle.seeds.length}`;
  if (Math.abs(togo) <= IN_PLACE_MM) return { text: `${which}: the needle is in place. Drop it.`, inPlace: true };
  return { text: `${which}: ${togo > 0 ? 'push in' : 'pull back'} ${Math.abs(togo).toFixed(1)} mm`, inPlace: false };
}

/** The hand's task with a needle that is drawn back over its train. `number` counts the seed that is left next. */
function whatToDoWithTrain(needle: PlanNeedle, number: number, seed: PlanSeed, implant: Implant | null, depth: number): { text: string; inPlace: boolean } {
  const from = implant?.train_from_mm ?? null;
  if (from !== null) {
    const togo = depth - (seed.drop_depth_mm + from - needle.depth_mm);
    return { text: `Needle ${needle.name}: draw back. Seed ${number} of ${needle.seeds.length} is left in ${Math.max(0, togo).toFixed(1)} mm`, inPlace: false };
  }
  const togo = needle.depth_mm - depth;
  const count = needle.seeds.length - number + 1;
  const which = `Needle ${needle.name}, train of ${count} ${count === 1 ? 'seed' : 'seeds'}`;
  if (Math.abs(togo) <= IN_PLACE_MM) return { text: `Needle ${needle.name} is in place. Drop, then draw back.`, inPlace: true };
  return { text: `${which}: ${togo > 0 ? 'push in' : 'pull back'} ${Math.abs(togo).toFixed(1)} mm`, inPlace: false };
}

/** Whether the needle has to go to its full depth, where a train is begun. */
export function isBeforeTrain(plan: Plan | null, implant: Implant | null): boolean {
  return plan?.technique === 'preloaded' && implant?.train_from_mm == null && nextSeed(plan, implant) !== null;
}

/** The depths of the base at which the present needle leaves its seeds: of a train from where it was begun. */
export function seedDepths(plan: Plan | null, implant: Implant | null): number[] | null {
  const needle = currentNeedle(plan);
  const shift = needle && implant?.train_from_mm != null ? implant.train_from_mm - needle.depth_mm : 0;
  return needle ? needle.seeds.map((seed) => seed.drop_depth_mm + shift) : null;
}

/** The depth to which the needle has to go next; null: it has no seed. */
export function depthToGo(plan: Plan | null, implant: Implant | null): number | null {
  const seed = nextSeed(plan, implant);
  const needle = currentNeedle(plan);
  if (!seed || !needle) return null;
  if (plan!.technique !== 'preloaded') return seed.drop_depth_mm;
  const depths = seedDepths(plan, implant)!;
  return isBeforeTrain(plan, implant) ? needle.depth_mm : depths[depths.length - 1] - BEHIND_TRAIN_MM;
}

/** The words of the panel while a recording is shown: what its needle had dropped at the moment that is shown. */
export function replayWords(plan: Plan, implant: Implant | null): string {
  const needle = currentNeedle(plan);
  const which = needle ? `Needle ${needle.name}, ${droppedOf(implant, plan.current)} of ${needle.seeds.length} seeds dropped` : 'A needle beside the plan';
  return `Recording. ${which}.`;
}

/** The mean motion [mm] of the dropped seeds from where they rest; zero without seeds. */
export function meanMotion(implant: Implant | null, seeds: Seeds | null): Place {
  const sum: Place = [0, 0, 0];
  const there = (implant?.seeds ?? []).flatMap((seed, i) => (seed.lost || !seeds?.now_mm[i] ? [] : [i]));
  for (const i of there) {
    for (let k = 0; k < 3; k++) sum[k] += (seeds!.now_mm[i][k] - implant!.seeds[i].rest_mm[k]) / there.length;
  }
  return sum;
}

/** Where the dropped seeds are now; those whose place has not been told yet where they rest. A lost seed is nowhere. */
export function placesNow(implant: Implant | null, seeds: Seeds | null): (Place | null)[] {
  return implant?.seeds.map((seed, i) => (seed.lost ? null : seeds?.now_mm[i] ?? seed.rest_mm)) ?? [];
}

const times = (count: number): string => (count === 0 ? 'never' : count === 1 ? 'once' : count === 2 ? 'twice' : `${count} times`);

/** What all needles so far have done to the patient, as rows of a table. */
export function tallyRows({ skin_punctures, organ_entries, bone_contacts, exits }: Tally): { what: string; often: string; harm: boolean }[] {
  return [
    { what: 'Skin broken', often: times(skin_punctures), harm: false },
    { what: 'Rectum, bladder or urethra entered', often: times(organ_entries), harm: organ_entries > 0 },
    { what: 'Bone met', often: times(bone_contacts), harm: bone_contacts > 0 },
    ...(exits > 0 ? [{ what: 'Out through the far side', often: times(exits), harm: true }] : []),
  ];
}

/** How many of the dropped seeds have left the patient. */
export function lostSeeds(implant: Implant | null): number {
  return implant?.seeds.filter((seed) => seed.lost).length ?? 0;
}
