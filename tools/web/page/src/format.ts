// SPDX-License-Identifier: BSD-3-Clause
// Numbers and times as people read them.

/** Fixed decimals; a dash for what is unknown. */
export function fixed(value: number | null | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
}

/** "12.3 k": a count in at most five characters. */
export function count(value: number | null | undefined): string {
  if (value === null || value === undefined) return '–';
  if (value < 10_000) return String(value);
  return value < 1_000_000 ? `${(value / 1e3).toFixed(value < 100_000 ? 1 : 0)} k` : `${(value / 1e6).toFixed(2)} M`;
}

/** "1:02:03" or "4:05.6": a span of time. */
export function span(seconds: number, decimals = 0): string {
  const sign = seconds < 0 ? '−' : '';
  const rounded = Number(Math.abs(seconds).toFixed(decimals));
  const hours = Math.floor(rounded / 3600);
  const minutes = Math.floor((rounded % 3600) / 60);
  const rest = (rounded % 60).toFixed(decimals).padStart(decimals ? decimals + 3 : 2, '0');
  return hours ? `${sign}${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${sign}${minutes}:${rest}`;
}

/** "3 d 4 h", "5 min", "12 s": how long something has gone on. */
export function about(seconds: number): string {
  if (seconds < 60) return `${Math.floor(seconds)} s`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min`;
  if (seconds < 86_400) return `${Math.floor(seconds / 3600)} h ${Math.floor((seconds % 3600) / 60)} min`;
  return `${Math.floor(seconds / 86_400)} d ${Math.floor((seconds % 86_400) / 3600)} h`;
}
