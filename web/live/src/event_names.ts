// SPDX-License-Identifier: GPL-3.0-or-later
import type { Event } from './wire';

const NAMES: Record<string, string> = {
  skin_contact: 'Skin touched', puncture: 'Punctured', region_entered: 'Into', retraction_start: 'Retraction', slip_start: 'Slips',
  withdrawn: 'Out', bone_contact: 'Bone', exited: 'Through', re_entered: 'Back in its track', started: 'Start',
};
const BONE_OR_OUT = new Set(['bone_contact', 'exited']);
let spared = new Set<string>();
const WITH_REGION = new Set(['puncture', 'region_entered']);
/** Whether a region fills the space between the organs; its surface is the skin (is_surrounding() in C++). */
const isSurrounding = (region: string): boolean => region === 'body' || region === 'levator' || region.endsWith('_fat');
let labels = new Map<string, string>();

/** Sets the labels of the regions of the case that is shown. */
export function nameRegions(regions: { name: string; label: string; spared?: boolean }[]): void {
  spared = new Set(regions.filter((r) => r.spared).map((r) => r.name));
  labels = new Map(regions.map((r) => [r.name, r.label.toLowerCase()]));
}

export function regionLabel(name: string): string {
  return labels.get(name) ?? name;
}

export function eventLabel(event: Event): string {
  const name = NAMES[event.kind] ?? event.kind.replaceAll('_', ' ');
  if (event.kind === 'puncture' && isSurrounding(event.region)) return `${name} skin`;
  return WITH_REGION.has(event.kind) && event.region ? `${name} ${regionLabel(event.region)}` : name;
}

/** Whether an event harms the patient: the needle enters an organ to be spared, meets bone or leaves the body. */
export function isHarm(event: Event): boolean {
  return BONE_OR_OUT.has(event.kind) || (event.kind === 'region_entered' && spared.has(event.region));
}

export function harmSentence(event: Event): string {
  const at = `at ${event.depth_mm.toFixed(0)} mm`;
  if (event.kind === 'exited') return `Needle came out of the body ${at}`;
  const region = event.region ? regionLabel(event.region) : 'tissue';
  return event.kind === 'bone_contact' ? `Needle met bone (${region}) ${at}` : `Needle entered the ${region} ${at}`;
}
