// SPDX-License-Identifier: GPL-3.0-or-later
import type { Event } from './wire';

const NAMES: Record<string, string> = {
  skin_contact: 'Skin touched', puncture: 'Punctured', region_entered: 'Into', retraction_start: 'Retraction', slip_start: 'Slips',
  withdrawn: 'Out', bone_contact: 'Bone', exited: 'Through', re_entered: 'Back in its track', started: 'Start',
};
const WITH_REGION = new Set(['puncture', 'region_entered']);
let labels = new Map<string, string>();

/** What regions are called in the case that is shown. */
export function nameRegions(regions: { name: string; label: string }[]): void {
  labels = new Map(regions.map((r) => [r.name, r.label.toLowerCase()]));
}

export function regionLabel(name: string): string {
  return labels.get(name) ?? name;
}

export function eventLabel(event: Event): string {
  const name = NAMES[event.kind] ?? event.kind.replaceAll('_', ' ');
  return WITH_REGION.has(event.kind) && event.region ? `${name} ${regionLabel(event.region)}` : name;
}
