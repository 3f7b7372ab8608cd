// SPDX-License-Identifier: BSD-3-Clause
// The binary form of the map: /api/map, or its base64 text in a report. docs/web.md describes it.

/** Points of one cube of space. */
export interface MapChunk {
  key: string;
  /** Corner of the cube in the map frame [m]. */
  corner_m: [number, number, number];
  /** x, y, z in steps from the corner, and intensity (0 … 255): four numbers a point; none: the cube is empty now. */
  points: Uint16Array;
}

export interface MapPiece {
  epoch: number;
  /** The newest change that these chunks bring; where to go on. */
  change: number;
  /** More changes wait on the server. */
  more: boolean;
  step_m: number;
  chunks: MapChunk[];
}

const kMagic = 0x504d4249; // "IBMP", little endian
const kHeaderBytes = 32;
const kChunkBytes = 20;

/** @throws Error when the bytes are not a whole piece */
export function decode_map(buffer: ArrayBuffer): MapPiece {
  const view = new DataView(buffer);
  if (buffer.byteLength < kHeaderBytes || view.getUint32(0, true) !== kMagic || view.getUint32(4, true) !== 1) {
    throw new Error('this is not a map of this version of Isobar');
  }
  const edge_m = view.getFloat32(20, true);
  const piece: MapPiece = {
    epoch: view.getUint32(8, true),
    change: view.getUint32(12, true),
    more: view.getUint32(16, true) !== 0,
    step_m: view.getFloat32(24, true),
    chunks: [],
  };
  const count = view.getUint32(28, true);
  let at = kHeaderBytes;
  for (let i = 0; i < count; ++i) {
    if (at + kChunkBytes > buffer.byteLength) throw new Error('the map is cut');
    const index = [0, 4, 8].map((offset) => view.getInt32(at + offset, true));
    const points = view.getUint32(at + 12, true);
    at += kChunkBytes;
    if (at + 8 * points > buffer.byteLength) throw new Error('the map is cut');
    piece.chunks.push({
      key: index.join(','),
      corner_m: [index[0] * edge_m, index[1] * edge_m, index[2] * edge_m],
      // A copy: chunks stand at multiples of 4, and a piece is freed when its chunks are on the graphics card.
      points: new Uint16Array(buffer.slice(at, at + 8 * points)),
    });
    at += 8 * points;
  }
  return piece;
}
