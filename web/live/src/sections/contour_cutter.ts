// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a closed surface of triangles with a plane perpendicular to an axis. Each edge that the plane crosses gives a
// corner of a contour; each triangle that it crosses joins two corners. All memory is allocated in the constructor.

const NONE = -1;

export class ContourCutter {
  /** (2 × corners) the other two coordinates, ordered by axis, contour after contour */
  readonly corners: Float32Array;
  /** (contours + 1) number of the first corner of each contour in `corners` */
  readonly starts: Uint32Array;
  contours = 0;
  private readonly edgeNodes: Uint32Array;      // (2 × edges) node numbers
  private readonly triangleEdges: Uint32Array;  // (3 × triangles) edge numbers
  private readonly links: Int32Array;           // (2 × edges) neighbours of a crossed edge along the contour
  private readonly crossed: Uint32Array;        // edges that the plane crosses
  private crossings = 0;

  /** @param triangles (3 × triangles) node numbers */
  constructor(triangles: Uint32Array) {
    const numbers = new Map<number, number>();
    const nodes: number[] = [];
    this.triangleEdges = new Uint32Array(triangles.length);
    const most = triangles.reduce((m, n) => Math.max(m, n), 0) + 1;
    for (let t = 0; t < triangles.length; t += 3) {
      for (let k = 0; k < 3; k++) {
        const a = triangles[t + k];
        const b = triangles[t + ((k + 1) % 3)];
        const key = Math.min(a, b) * most + Math.max(a, b);
        let edge = numbers.get(key);
        if (edge === undefined) {
          numbers.set(key, (edge = numbers.size));
          nodes.push(Math.min(a, b), Math.max(a, b));
        }
        this.triangleEdges[t + k] = edge;
      }
    }
    this.edgeNodes = Uint32Array.from(nodes);
    this.links = new Int32Array(nodes.length).fill(NONE);
    this.crossed = new Uint32Array(nodes.length / 2);
    this.corners = new Float32Array(nodes.length);
    this.starts = new Uint32Array(nodes.length / 2 + 1);
  }

  /** Cuts with the plane where the coordinate `axis` (0, 1, 2) is `value`. @param position (3 × nodes) */
  cut(position: Float32Array, axis: number, value: number): void {
    const { edgeNodes, triangleEdges, links, crossed } = this;
    this.crossings = 0;
    for (let e = 0; e < edgeNodes.length / 2; e++) {
      // A node in the plane counts as above it, as if the plane were moved by an infinitesimal distance.
      const above = position[3 * edgeNodes[2 * e] + axis] >= value;
      if (above === position[3 * edgeNodes[2 * e + 1] + axis] >= value) continue;
      crossed[this.crossings++] = e;
      links[2 * e] = links[2 * e + 1] = NONE;
    }
    if (this.crossings > 0) {
      for (let t = 0; t < triangleEdges.length; t += 3) this.join(t, position, axis, value);
    }
    this.collect(position, axis, value);
  }

  private join(t: number, position: Float32Array, axis: number, value: number): void {
    let first = NONE;
    for (let k = 0; k < 3; k++) {
      const e = this.triangleEdges[t + k];
      const above = position[3 * this.edgeNodes[2 * e] + axis] >= value;
      if (above === position[3 * this.edgeNodes[2 * e + 1] + axis] >= value) continue;
      if (first === NONE) first = e;
      else {
        this.link(first, e);
        this.link(e, first);
      }
    }
  }

  private link(e: number, other: number): void {
    const { links } = this;
    if (links[2 * e] === NONE) links[2 * e] = other;
    // further neighbours, of surfaces that touch along an edge, are ignored
    else if (links[2 * e + 1] === NONE) links[2 * e + 1] = other;
  }

  /** Follows the links from edge to edge and removes the links of the edges that it has passed. */
  private collect(position: Float32Array, axis: number, value: number): void {
    const { links } = this;
    const [across, along] = axis === 0 ? [1, 2] : axis === 1 ? [0, 2] : [0, 1];
    let count = 0;
    this.contours = 0;
    for (let i = 0; i < this.crossings; i++) {
      let e = this.crossed[i];
      if (links[2 * e] === NONE) continue;
      const begin = count;
      while (e !== NONE) {
        const [a, b] = [3 * this.edgeNodes[2 * e], 3 * this.edgeNodes[2 * e + 1]];
        const share = (value - position[a + axis]) / (position[b + axis] - position[a + axis]);
        this.corners[2 * count] = position[a + across] + share * (position[b + across] - position[a + across]);
        this.corners[2 * count + 1] = position[a + along] + share * (position[b + along] - position[a + along]);
        count++;
        const [one, two] = [links[2 * e], links[2 * e + 1]];
        links[2 * e] = links[2 * e + 1] = NONE;
        e = one !== NONE && links[2 * one] !== NONE ? one : two !== NONE && links[2 * two] !== NONE ? two : NONE;
      }
      if (count - begin < 3) count = begin;
      else this.starts[this.contours++] = begin;
    }
    this.starts[this.contours] = count;
  }
}
