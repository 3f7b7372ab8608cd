// SPDX-License-Identifier: BSD-3-Clause
// Colour of a height: from violet-blue over teal to yellow, of steadily rising lightness, so that it reads without
// colours, too. Interpolated in Oklab. On a light ground the range is darker, so that both ends stand out from it.

/** Lightness, chroma and hue [deg] in Oklch at equal steps. */
const kOnDark = [[0.42, 0.17, 295], [0.52, 0.14, 262], [0.62, 0.12, 222], [0.72, 0.13, 172], [0.82, 0.17, 132], [0.92, 0.18, 104]];
const kOnLight = [[0.3, 0.15, 295], [0.41, 0.15, 268], [0.5, 0.11, 232], [0.58, 0.11, 175], [0.66, 0.15, 135], [0.74, 0.15, 92]];

export const kColours = 256;

function srgb(linear: number): number {
  const value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
  return Math.round(255 * Math.min(1, Math.max(0, value)));
}

/** sRGB, 0 … 255, of a colour in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020). */
function rgb_of(lightness: number, a: number, b: number): [number, number, number] {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    srgb(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

/** RGBA bytes of kColours colours, the lowest height first. */
export function height_colours(dark: boolean): Uint8Array {
  const stops = (dark ? kOnDark : kOnLight).map(([lightness, chroma, hue]) => {
    const angle = (hue * Math.PI) / 180;
    return [lightness, chroma * Math.cos(angle), chroma * Math.sin(angle)];
  });
  const bytes = new Uint8Array(4 * kColours);
  for (let i = 0; i < kColours; ++i) {
    const at = (i / (kColours - 1)) * (stops.length - 1);
    const first = Math.min(Math.floor(at), stops.length - 2);
    const mixed = stops[first].map((value, axis) => value + (at - first) * (stops[first + 1][axis] - value));
    bytes.set([...rgb_of(mixed[0], mixed[1], mixed[2]), 255], 4 * i);
  }
  return bytes;
}

/** The same as a CSS gradient; `angle` as in linear-gradient(). */
export function height_gradient(dark: boolean, angle: string): string {
  const bytes = height_colours(dark);
  const stops = Array.from({ length: 17 }, (_, i) => {
    const at = 4 * Math.round((i / 16) * (kColours - 1));
    return `rgb(${bytes[at]} ${bytes[at + 1]} ${bytes[at + 2]})`;
  });
  return `linear-gradient(${angle}, ${stops.join(', ')})`;
}
