// @ts-check
/**
 * The picture in a browser: words and a table of 1024 entries, and the controls that rewrite the entries.
 *
 * A page holds the picture once, as words. A recoloring computes the entries of one surface and looks up the
 * colors of its pixels again; no word changes. The strength of a light changes words, which are computed from
 * light planes; then no entry changes. A page that turns holds the words of each view; all views have one
 * table. A page keeps its own history, and writes its values into the link's fragment. In a notebook the host
 * keeps the history: edits are shown at once and sent to the host.
 *
 * Keys and values are those of the command line: `surfaces.body.object_color`, `lights.key.intensity`.
 */

/** @typedef {string | number | boolean | string[] | null} Value */
/** @typedef {Record<string, Value>} State  The values by key. */
/** @typedef {[number, number, number]} Color  Red, green and blue, 0 to 255. */
/** @typedef {{object_color: string, light_color: string, blend: number, light_percentage: number,
 *   ramp: string[] | null}} Paint */
/** @typedef {{name: string, first: number, levels: number, shades: number, floor: number, fixed: string,
 *   paint: Paint}} Surface */
/** @typedef {{name: string, on: boolean, intensity: number, most: number, units: number[],
 *   plane?: string}} LightRow */
/**
 * @typedef {{held: string, exposure: string, ambient: number, rows: LightRow[], levels: string[],
 *   dither: boolean}} Lights
 */
/** @typedef {{name: string, values: State}} Variant */
/** @typedef {string | ArrayBufferView} Packed  Bytes, or their base64. */
/** @typedef {{format: string, name: string, lines: number, elements: number, smooth: number, words: Packed,
 *   entries: Packed, background: string, surfaces: Surface[], notes: string[], variants: Variant[],
 *   legend: null | {line: number, element: number, lines: number, elements: number, words: Packed},
 *   swatches: Record<string, string>, views: {name: string, words: string}[], line?: string, link?: string,
 *   lights: Lights | null, undo?: number, redo?: number}} Picture */
/**
 * @typedef {{edit?: (edits: State, sameStep: boolean) => void, undo?: () => void, redo?: () => void}} Options
 */
/** @typedef {Uint8Array<ArrayBuffer>} Bytes */
/** @typedef {Uint16Array<ArrayBuffer>} Words */

const ENTRIES = 1024;
/** So many pixels of the screen a click may move before it is a drag. */
const NEAR = 6;
const COUNT = new Intl.NumberFormat("en");
const PAINT = /** @type {const} */ (["object_color", "light_color", "blend", "light_percentage", "ramp"]);

// ---------------------------------------------------------------------------------------------------------
// Packed values

/** The bytes of packed values. @param {Packed} packed @returns {Bytes} */
export function bytesOf(packed) {
  if (typeof packed === "string") {
    const letters = atob(packed);
    const bytes = new Uint8Array(letters.length);
    for (let at = 0; at < bytes.length; at++) bytes[at] = letters.charCodeAt(at);
    return bytes;
  }
  return new Uint8Array(/** @type {ArrayBuffer} */ (packed.buffer), packed.byteOffset, packed.byteLength);
}

/** The bytes of values that zlib compressed. @param {Packed} packed @returns {Promise<Bytes>} */
export async function inflated(packed) {
  const stream = new Blob([bytesOf(packed)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * The words of a raster. Each has a byte: the difference to the word on its left, or 128 for a word that
 * follows whole, after all of these bytes.
 * @param {Packed} packed @param {number} lines @param {number} elements @returns {Promise<Words>}
 */
export async function unpackWords(packed, lines, elements) {
  const bytes = await inflated(packed);
  const words = new Uint16Array(lines * elements);
  let whole = words.length;
  for (let line = 0, at = 0; line < lines; line++) {
    for (let element = 0, word = 0; element < elements; element++, at++) {
      if (bytes[at] !== 128) word += (bytes[at] << 24) >> 24;
      else {
        word = bytes[whole] | (bytes[whole + 1] << 8);
        whole += 2;
      }
      words[at] = word;
    }
  }
  return words;
}

/**
 * The plane of a light, 16 bits a point: differences, the low bytes of all before the high bytes.
 * @param {Packed} packed @returns {Promise<Words>}
 */
export async function unpackPlane(packed) {
  const bytes = await inflated(packed);
  const plane = new Uint16Array(bytes.length / 2);
  for (let at = 0, value = 0; at < plane.length; at++) {
    value += bytes[at] | (bytes[plane.length + at] << 8);
    plane[at] = value;
  }
  return plane;
}

// ---------------------------------------------------------------------------------------------------------
// Colors

/** The color of "#rrggbb". @param {string} text @returns {Color} */
export function colorOf(text) {
  const number = parseInt(text.slice(1), 16);
  return [number >> 16, (number >> 8) & 255, number & 255];
}

/** The color as "#rrggbb". @param {ArrayLike<number>} color */
export function inDigits(color) {
  return "#" + Array.from(color, (part) => part.toString(16).padStart(2, "0")).join("");
}

/** The color of a CSS color as "#rrggbb"; empty if it is none, or not opaque. @param {string} text */
function cssColor(text) {
  const bare = /^[0-9a-f]{3}([0-9a-f]{3})?$/i.test(text.trim()) ? `#${text.trim()}` : text.trim();
  if (!CSS.supports("color", bare) || /^(current|inherit|initial|unset|revert)/i.test(bare)) return "";
  const context = make("canvas", { width: 1, height: 1 }).getContext("2d", { willReadFrequently: true });
  if (!context) return "";
  context.fillStyle = bare;
  context.fillRect(0, 0, 1, 1);
  const [red, green, blue, alpha] = context.getImageData(0, 0, 1, 1).data;
  return alpha === 255 ? inDigits([red, green, blue]) : "";
}

/**
 * The entries of a paint, three bytes a level from the lowest level up, equal to `mapping.colors.entries_of`.
 *
 * Up to the blend level the object color, then in equal steps toward the light color, all darkened in
 * proportion to the level; the small excess makes up for rounding. A ramp gives each level its color.
 * @param {Paint} paint @param {number} levels @param {number} floor @returns {Bytes}
 */
export function entriesOf(paint, levels, floor) {
  const entries = new Uint8Array(3 * levels);
  const steps = Math.max(levels - 1, 1);
  if (paint.ramp) {
    const colors = paint.ramp.map(colorOf);
    const last = colors.length - 1;
    for (let level = 0; level < levels; level++) {
      const below = Math.min(Math.floor((level * last) / steps), last - 1);
      const above = level * last - below * steps;
      for (let part = 0; part < 3; part++) {
        const sum = colors[below][part] * (steps - above) + colors[below + 1][part] * above;
        entries[3 * level + part] = Math.floor((2 * sum + steps) / (2 * steps));
      }
    }
    return entries;
  }
  const object = colorOf(paint.object_color);
  const light = colorOf(paint.light_color);
  const begin = Math.floor(paint.blend * (levels - 1) + 0.5);
  for (let level = 0; level < levels; level++) {
    const weight =
      (Math.max(level - begin, 0) / Math.max(levels - 1 - begin, 1)) * (paint.light_percentage / 100);
    const share = floor + ((1 - floor) * level) / steps;
    for (let part = 0; part < 3; part++) {
      entries[3 * level + part] =
        (1 - weight) * share * object[part] + weight * share * light[part] + 0.500000001;
    }
  }
  return entries;
}

/**
 * All entries of a picture: a host sends them, and a page computes those of the surfaces that it can recolor.
 * @param {Picture} picture
 */
async function entriesIn({ entries, surfaces }) {
  if (typeof entries !== "string") return bytesOf(entries).slice();
  const all = await inflated(entries);
  for (const { first, levels, floor, fixed, paint } of surfaces) {
    if (!fixed) all.set(entriesOf(paint, levels, floor), 3 * first);
  }
  return all;
}

/** The white of a color: the mean of its components, rounded half up. @param {Color} color */
export function whiteOf(color) {
  return Math.floor((color[0] + color[1] + color[2]) / 3 + 0.5);
}

/**
 * The color with the same amount added to each component, such that their mean is `white`.
 * @param {Color} color @param {number} white @returns {Color}
 */
export function withWhite(color, white) {
  /** @type {Color} */
  let nearest = color;
  for (let amount = -255, least = Infinity; amount <= 255; amount++) {
    const tint = /** @type {Color} */ (color.map((part) => Math.min(Math.max(part + amount, 0), 255)));
    const away = Math.abs(tint[0] + tint[1] + tint[2] - 3 * white);
    if (away < least) [least, nearest] = [away, tint];
  }
  return nearest;
}

/** The light of a component of a color, 0 to 255, as sRGB shows it: 0 to 1. @param {number} component */
function lightOf(component) {
  const share = component / 255;
  return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
}

/**
 * The colors of pixels, averaged as light over squares of `smooth` pixels a side; equal to `images.averaged`.
 * @param {Uint32Array} pixels @param {number} elements @param {number} smooth @returns {ImageData}
 */
export function averaged(pixels, elements, smooth) {
  const lines = pixels.length / elements / smooth;
  const image = new ImageData(elements / smooth, lines);
  const light = Float64Array.from({ length: 256 }, (_, component) => lightOf(component));
  const between = Float64Array.from({ length: 255 }, (_, component) => lightOf(component + 0.5));
  for (let at = 0; at < image.width * lines; at++) {
    const corner = Math.floor(at / image.width) * smooth * elements + (at % image.width) * smooth;
    for (let part = 0; part < 3; part++) {
      let sum = 0;
      for (let down = 0; down < smooth; down++) {
        for (let across = 0; across < smooth; across++) {
          sum += light[(pixels[corner + down * elements + across] >>> (8 * part)) & 255];
        }
      }
      image.data[4 * at + part] = countUpTo(between, sum / smooth ** 2);
    }
    image.data[4 * at + 3] = 255;
  }
  return image;
}

/**
 * How many of some rising numbers are at most a value.
 * @param {ArrayLike<number>} numbers @param {number} value
 */
function countUpTo(numbers, value) {
  let low = 0;
  for (let high = numbers.length; low < high;) {
    const middle = (low + high) >> 1;
    if (numbers[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}

// ---------------------------------------------------------------------------------------------------------
// Light

const CELLS = 16384;

/**
 * Where to begin the search for the level of an intensity: equal cells between the lowest and the highest
 * threshold, each with a level that is at most its own. The thresholds end with infinity.
 *
 * Measured on the coupe: the search takes a third of the time of a binary search.
 * @param {Float32Array} thresholds
 */
function levelSearch(thresholds) {
  const finite = thresholds.filter(Number.isFinite);
  const low = finite[0] ?? 0;
  const scale = finite.length > 1 ? CELLS / (finite[finite.length - 1] - low) : 0;
  // A cell begins at the level of the cell before it, for its own edge is rounded.
  const begin = Uint16Array.from({ length: CELLS + 1 }, (_, cell) =>
    scale && cell ? countUpTo(thresholds, low + (cell - 1) / scale) : 0,
  );
  return { low, scale, begin, thresholds: Float32Array.of(...thresholds, Infinity) };
}

/**
 * The rank of a pixel in the tile of ordered dither, 0 to 63.
 * @param {number} line @param {number} element
 */
function rankOf(line, element) {
  let rank = 0;
  for (let bit = 0; bit < 3; bit++)
    rank = 4 * rank + [0, 2, 3, 1][2 * ((line >> bit) & 1) + ((element >> bit) & 1)];
  return rank;
}

/**
 * Write the words of a run of points from their intensities; returns how many words changed.
 *
 * Measured: in a function of its own, without captured variables, the loop takes two thirds of the time.
 * @param {Words} words @param {number} place @param {number} end @param {Surface} surface
 * @param {ReturnType<typeof levelSearch>} search
 * @param {Float32Array} sums  The light of the other lights.
 * @param {Words} plane @param {number} at  The place of the first point in `sums` and `plane`.
 * @param {number} factor  The intensity of a unit of the plane.
 * @param {boolean} isKept  Whether only this light changed: points that it does not reach keep their words.
 * @param {number} width  With dither, the elements of a line; otherwise 0.
 */
function relevel(words, place, end, surface, search, sums, plane, at, factor, isKept, width) {
  const { first, levels, shades } = surface;
  const { low, scale, begin, thresholds } = search;
  let changed = 0;
  for (; place < end; place++, at++) {
    if (isKept && plane[at] === 0) continue;
    const intensity = sums[at] + factor * plane[at];
    const cell = (intensity - low) * scale;
    let level = begin[cell < CELLS ? (cell > 0 ? cell | 0 : 0) : CELLS];
    while (thresholds[level] <= intensity) level++;
    if (width) level = (level + rankOf(Math.floor(place / width), place % width)) >> 6;
    const before = words[place];
    const word = (shades === levels ? first : before - ((before - first) % shades)) + level;
    if (word === before) continue;
    words[place] = word;
    changed++;
  }
  return changed;
}

/**
 * The function that writes the words for some values of lights and returns how many words changed. It is null
 * for a picture without light planes.
 *
 * The intensity at a point is the ambient light plus the sum of the contributions of the lights that are on.
 * The sum of all lights but one is cached, so that a drag of one strength adds one plane. With dither, each
 * level has 64 steps.
 * @param {Picture} picture @param {Words} words @param {Uint8Array} owner
 * @returns {Promise<((state: State, name: string) => number) | null>}
 */
export async function relighting({ surfaces, lights, elements }, words, owner) {
  if (!lights || !lights.rows.every((row) => row.plane)) return null;
  const planes = await Promise.all(lights.rows.map((row) => unpackPlane(row.plane ?? "")));
  const searches = await Promise.all(
    lights.levels.map(async (each) => levelSearch(new Float32Array((await inflated(each)).buffer))),
  );
  const width = lights.dither ? elements : 0;
  /** The points of each surface as runs of words: first, end, first, end. @type {number[][]} */
  const runs = surfaces.map(() => []);
  for (let at = 0; at < words.length; at++) {
    const run = runs[owner[words[at]] - 1];
    if (run?.at(-1) === at) run[run.length - 1]++;
    else run?.push(at, at + 1);
  }
  /** The place in the planes at which each surface begins. */
  const begins = [0];
  runs.forEach((run, number) =>
    begins.push(begins[number] + run.reduce((sum, at, edge) => sum + (edge % 2 ? at : -at), 0)),
  );
  const sums = new Float32Array(begins[surfaces.length]);
  const exported = words.slice();
  let summed = "";

  return (state, name) => {
    const strengths = lights.rows.map((row) =>
      state[`lights.${row.name}.on`] ? Number(state[`lights.${row.name}.intensity`]) : 0,
    );
    // The words as exported are exact; the planes have 16 bits.
    if (lights.rows.every(({ on, intensity }, row) => strengths[row] === (on ? intensity : 0))) {
      const changed = countOfChanges(words, exported);
      words.set(exported);
      summed = "";
      return changed;
    }
    const chosen = lights.rows.findIndex((row) => row.name === name);
    const others = JSON.stringify([
      chosen,
      strengths.map((strength, row) => (row === chosen ? null : strength)),
    ]);
    const isKept = others === summed;
    if (!isKept) {
      sums.fill(lights.ambient);
      strengths.forEach((strength, row) => {
        const plane = planes[row];
        if (row === chosen || strength === 0) return;
        for (let number = 0; number < surfaces.length; number++) {
          const factor = strength * lights.rows[row].units[number];
          for (let at = begins[number], end = begins[number + 1]; at < end; at++)
            sums[at] += factor * plane[at];
        }
      });
      summed = others;
    }
    let changed = 0;
    for (let number = 0; number < surfaces.length; number++) {
      const factor = strengths[chosen] * lights.rows[chosen].units[number];
      const plane = planes[chosen];
      const search = searches[number];
      for (let run = 0, at = begins[number]; run < runs[number].length; run += 2) {
        const [place, end] = runs[number].slice(run, run + 2);
        changed += relevel(words, place, end, surfaces[number], search, sums, plane, at, factor, isKept, width);
        at += end - place;
      }
    }
    return changed;
  };
}

// ---------------------------------------------------------------------------------------------------------
// Values by key

/** The values that a picture was exported with. @param {Picture} picture @returns {State} */
export function stateOf(picture) {
  /** @type {State} */
  const state = {};
  for (const { name, fixed, paint } of picture.surfaces) {
    if (!fixed) for (const field of PAINT) state[`surfaces.${name}.${field}`] = paint[field];
  }
  for (const { name, on, intensity } of picture.lights?.rows ?? []) {
    state[`lights.${name}.on`] = on;
    state[`lights.${name}.intensity`] = intensity;
  }
  return state;
}

/** The paint of a surface. @param {State} state @param {string} name @returns {Paint} */
export function paintOf(state, name) {
  return /** @type {Paint} */ (
    Object.fromEntries(PAINT.map((field) => [field, state[`surfaces.${name}.${field}`]]))
  );
}

/** Whether two values are equal. @param {Value} one @param {Value} other */
function same(one, other) {
  return one === other || JSON.stringify(one) === JSON.stringify(other);
}

/** The keys whose values differ. @param {State} one @param {State} other */
function differing(one, other) {
  return Object.keys(one).filter((key) => !same(one[key], other[key]));
}

/** Whether all values are equal. @param {State} one @param {State} other */
function alike(one, other) {
  return Object.keys(one).every((key) => same(one[key], other[key]));
}

/** The name of the first light that keys belong to; empty if none. @param {string[]} keys */
function lightIn(keys) {
  const key = keys.find((each) => each.startsWith("lights."));
  return key?.slice(7).replace(/\.[^.]*$/, "") ?? "";
}

/** A value as the command line reads it. @param {Value} value */
function textOf(value) {
  return value === null ? "none" : String(value);
}

/**
 * The value of a text; undefined if it is none for this key.
 * @param {string} key @param {string} text @param {number} most  The largest intensity.
 * @returns {Value | undefined}
 */
function valueOf(key, text, most) {
  const field = key.slice(key.lastIndexOf(".") + 1);
  const digits = (/** @type {string} */ part) =>
    /^#?[0-9a-f]{6}$/i.test(part) ? `#${part.slice(-6).toLowerCase()}` : "";
  if (field === "on") return text === "true" || (text === "false" ? false : undefined);
  if (field.endsWith("_color")) return digits(text) || undefined;
  if (field === "ramp") {
    const colors = text.split(",").map(digits);
    return text === "none" ? null : colors.length > 1 && colors.every(Boolean) ? colors : undefined;
  }
  const number = text.trim() === "" ? NaN : Number(text);
  const top = field === "blend" ? 1 : field === "intensity" ? most : 100;
  return number >= 0 && number <= top ? number : undefined;
}

/**
 * The keys by their names in links: without the table, and an object color has the name of its surface. A key
 * has its own name, too, which it keeps in a link if another key has the short one.
 * @param {State} first @returns {Map<string, string>}
 */
function keysOfLinks(first) {
  const keys = new Map(Object.keys(first).map((key) => [key, key]));
  for (const key of [...keys.keys()]) {
    const name = key.replace(/^(surfaces|lights)\./, "").replace(/\.object_color$/, "");
    if (name !== "view" && !keys.has(name)) keys.set(name, key);
  }
  return keys;
}

/**
 * The values that differ from the first ones, and the number of a view unless it is 0, as a link's fragment.
 * @param {State} state @param {State} first @param {number} [view]
 */
export function fragmentOf(state, first, view = 0) {
  const names = new Map([...keysOfLinks(first)].map(([name, key]) => [key, name]));
  const valueIn = (/** @type {string} */ key) => textOf(state[key]).replaceAll("#", "");
  const pairs = differing(state, first).map((key) => [names.get(key), valueIn(key)]);
  if (view) pairs.unshift(["view", String(view + 1)]);
  return pairs.map((pair) => pair.map((text) => encodeURIComponent(text ?? "")).join("=")).join("&");
}

/**
 * The values of a link's fragment and the number of its view, or a sentence about why there are none.
 * @param {string} fragment @param {Picture} picture @param {State} first
 * @returns {{state: State, view: number} | string}
 */
export function stateOfFragment(fragment, picture, first) {
  const state = { ...first };
  const keys = keysOfLinks(first);
  let view = 0;
  for (const pair of fragment.split("&").filter(Boolean)) {
    const at = pair.indexOf("=");
    let key, text;
    try {
      [key, text] = [pair.slice(0, Math.max(at, 0)), pair.slice(at + 1)].map(decodeURIComponent);
    } catch {
      key = text = "";
    }
    if (key === "view" && picture.views[Number(text) - 1]) {
      view = Number(text) - 1;
      continue;
    }
    key = keys.get(key) ?? key;
    const isKey = Object.hasOwn(first, key);
    const row = picture.lights?.rows.find((each) => key === `lights.${each.name}.intensity`);
    const value = isKey ? valueOf(key, text, row?.most ?? 0) : undefined;
    if (value === undefined) {
      const what = isKey || (key === "view" && picture.views.length > 0)
        ? `${key} cannot be “${text.slice(0, 40)}”`
        : `it has no “${(key || pair).slice(0, 40)}”`;
      return `The link does not fit this picture: ${what}. Nothing was changed.`;
    }
    state[key] = value;
  }
  return { state, view };
}

/**
 * The values as a table for `autocolor sweep --table`: a row of keys and a row of values. A surface has its
 * ramp, or its two colors and their blend. If the lights differ from the exported ones, the table also holds
 * the exposure of the picture, as the page does; otherwise the other light would be shown with its own.
 * @param {State} state @param {State} first @param {Picture} picture @returns {string}
 */
export function tableOf(state, first, { name, lights }) {
  const keys = Object.keys(state).filter((key) => {
    const ramp = `${key.slice(0, key.lastIndexOf("."))}.ramp`;
    if (!(ramp in state)) return true;
    return key === ramp ? state[ramp] !== null || first[ramp] !== null : state[ramp] === null;
  });
  const cell = (/** @type {string} */ text) =>
    /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  const rows = [["name", ...keys], [name, ...keys.map((key) => textOf(state[key]))]];
  if (lights && keys.some((key) => key.startsWith("lights.") && !same(state[key], first[key]))) {
    rows[0].push("exposure");
    rows[1].push(lights.exposure);
  }
  return rows.map((row) => row.map(cell).join(",") + "\r\n").join("");
}

// ---------------------------------------------------------------------------------------------------------
// The glass: words looked up in a table, on a canvas

/** @typedef {{left: number, top: number, right: number, bottom: number}} Box  Its edges are included. */

/**
 * Load entries into a table of colors.
 * @param {Uint32Array} table @param {number} first @param {Bytes} entries
 */
function load(table, first, entries) {
  for (let at = 0, part = 0; part < entries.length; at++, part += 3) {
    table[first + at] = 0xff000000 | (entries[part + 2] << 16) | (entries[part + 1] << 8) | entries[part];
  }
}

/**
 * The box around the pixels of each surface, which is empty for a surface that is not visible.
 * @param {Words} words @param {Uint8Array} owner @param {number} count  The surfaces.
 * @param {number} elements
 */
function boxesIn(words, owner, count, elements) {
  /** @type {() => Box} */
  const none = () => ({ left: elements, top: Infinity, right: -1, bottom: -1 });
  const boxes = Array.from({ length: count }, none);
  for (let line = 0, at = 0; at < words.length; line++) {
    for (let element = 0; element < elements; ) {
      const number = owner[words[at]];
      const begin = element;
      do {
        element++;
        at++;
      } while (element < elements && owner[words[at]] === number);
      const box = boxes[number - 1];
      if (!box) continue;
      box.left = Math.min(box.left, begin);
      box.right = Math.max(box.right, element - 1);
      box.bottom = line;
      box.top = Math.min(box.top, line);
    }
  }
  return boxes;
}

/** How many words differ. @param {Words} words @param {Words} others */
function countOfChanges(words, others) {
  let count = 0;
  for (let at = 0; at < words.length; at++) if (words[at] !== others[at]) count++;
  return count;
}

/**
 * The canvas of a picture.
 * @param {Picture} picture @param {Words} words @param {Bytes} entries @param {Words | null} legendWords
 */
function glassOf(picture, words, entries, legendWords) {
  const { lines, elements, smooth, surfaces, legend } = picture;
  const canvas = make("canvas", {
    width: elements, height: lines, role: "img", "aria-label": `Picture of ${picture.name}`,
  });
  const outline = make("canvas", { width: elements, height: lines, class: "outline" });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { alpha: false }));
  const image = context.createImageData(elements, lines);
  const pixels = new Uint32Array(image.data.buffer);
  const table = new Uint32Array(ENTRIES);
  /** The number of the surface that owns each word, from 1; 0 for none. */
  const owner = new Uint8Array(ENTRIES);
  surfaces.forEach(({ first, levels }, number) => owner.fill(number + 1, first, first + levels));
  const whole = { left: 0, top: 0, right: elements - 1, bottom: lines - 1 };
  let boxes = boxesIn(words, owner, surfaces.length, elements);

  /**
   * Look up the colors of all words in a box. Measured at 1280 x 960: a list of the surface's pixels takes as
   * long and four bytes a pixel.
   */
  function look(/** @type {Box} */ { left, top, right, bottom }) {
    const shown = words;
    for (let line = top; line <= bottom; line++) {
      const end = line * elements + right;
      for (let at = line * elements + left; at <= end; at++) pixels[at] = table[shown[at]];
    }
    drawLegend();
    if (left <= right) context.putImageData(image, 0, 0, left, top, right - left + 1, bottom - top + 1);
  }

  function drawLegend() {
    if (!legend || !legendWords) return;
    for (let at = 0; at < legendWords.length; at++) {
      const place =
        (legend.line + Math.floor(at / legend.elements)) * elements + legend.element + (at % legend.elements);
      pixels[place] = table[legendWords[at]];
    }
  }

  load(table, 0, entries);
  look(whole);

  return {
    canvas,
    outline,
    pixels,
    /** The colors of the entries, 255, blue, green and red from the highest byte down. */
    table,
    /** The words; whoever writes them calls `look`. */
    get words() {
      return words;
    },
    owner,
    whole,
    look,
    /** Show the words of another view; returns how many differ. */
    turn(/** @type {Words} */ next) {
      const changed = countOfChanges(words, next);
      words = next;
      boxes = boxesIn(words, owner, surfaces.length, elements);
      look(whole);
      return changed;
    },
    /** Rewrite the entries of a surface. */
    rewrite(/** @type {number} */ number, /** @type {Bytes} */ colors) {
      load(table, surfaces[number].first, colors);
      look(boxes[number]);
      if (legend)
        context.putImageData(image, 0, 0, legend.element, legend.line, legend.elements, legend.lines);
    },
    /** Draw the outline of a surface over the picture. */
    drawOutline(/** @type {number} */ number) {
      const dots = new Uint32Array(words.length);
      const away = Math.max(smooth, Math.round(elements / 640));
      const other = (/** @type {number} */ at) => owner[words[at]] !== number + 1;
      for (let at = away * elements; at < words.length - away * elements; at++) {
        if (other(at)) continue;
        const down = away * elements;
        if (other(at - away) || other(at + away) || other(at - down) || other(at + down)) dots[at] = 0xffffffff;
      }
      drawPixels(outline, dots);
    },
  };
}

// ---------------------------------------------------------------------------------------------------------
// The interface

/**
 * An element with attributes, listeners (`onclick`) and children.
 * @template {keyof HTMLElementTagNameMap} T
 * @param {T} tag @param {Record<string, unknown>} [attributes] @param {...(Node | string)} children
 * @returns {HTMLElementTagNameMap[T]}
 */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function")
      element.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    else element.setAttribute(name, String(value));
  }
  if (element instanceof HTMLButtonElement) element.type = "button";
  element.append(...children);
  return element;
}

/** A box of a class. @param {string} name @param {...(Node | string)} children */
function div(name, ...children) {
  return make("div", { class: name }, ...children);
}

/** An icon of 24 units a side, drawn by a path. @param {string} path */
function icon(path) {
  const frame = make("span");
  frame.innerHTML = `<svg viewBox="0 0 24 24"><path d="${path}"/></svg>`;
  return frame;
}

const UNDO = "M8 5 4 9l4 4M4 9h10a5 5 0 0 1 0 10H9";
const REDO = "M16 5l4 4-4 4M20 9H10a5 5 0 0 0 0 10h5";
const COMPARE = "M12 3v18M9 6H4v12h5M15 6h5v12h-5";
const LEFT = "M15 5l-7 7 7 7";
const RIGHT = "M9 5l7 7-7 7";

/**
 * What the parts of the interface share.
 * @typedef {object} Desk
 * @property {string} id  A prefix of names and ids.
 * @property {Picture} picture
 * @property {ReturnType<typeof glassOf>} glass
 * @property {State} first  The values as exported.
 * @property {State} state
 * @property {number} chosen  The number of the chosen surface, from 0.
 * @property {number} view  The number of the view that is shown, from 0.
 * @property {Array<() => void>} syncs  What shows the values in the controls.
 * @property {(edits: State, gesture?: string) => void} edit  Edits of the same gesture are one step.
 * @property {() => void} rest  The end of a gesture.
 * @property {(number: number) => void} choose
 * @property {(text: string) => void} say
 */

let mounted = 0;

/**
 * Build the interface in an element. With `options.edit` a host keeps the history; without it, the page does.
 * @param {HTMLElement} root @param {Picture} picture @param {Options} [options]
 */
export async function mount(root, picture, options = {}) {
  let built = await build(root, picture, options);
  let queue = Promise.resolve();
  return {
    /**
     * Show other words, entries or values of the host; see `update` of `build`.
     * @param {Partial<Picture> & {picture?: Picture}} news @param {string[]} [keys]
     */
    update({ words, entries, picture: changed }, keys = []) {
      queue = queue.then(async () => {
        picture = {
          ...picture, ...changed, words: words ?? picture.words, entries: entries ?? picture.entries,
        };
        if (await built.update(picture, keys)) return;
        built.destroy();
        built = await build(root, picture, options);
      });
      return queue;
    },
    /** Show a sentence of the host. @param {string} sentence */
    say(sentence) {
      queue = queue.then(() => built.say(sentence));
    },
    /** Remove the interface and its listeners. */
    destroy() {
      built.destroy();
    },
  };
}

/** The parts of a picture that a new interface is built for. @param {Picture} picture */
function structureOf({ lines, elements, smooth, surfaces, legend, lights, variants, notes }) {
  const rows = surfaces.map(({ name, first, levels, fixed }) => [name, first, levels, fixed]);
  const names = lights?.rows.map((row) => row.name);
  return JSON.stringify([lines, elements, smooth, rows, legend, lights?.held, names, variants, notes]);
}

/**
 * The interface of one picture.
 * @param {HTMLElement} root @param {Picture} picture @param {Options} options
 */
async function build(root, picture, options) {
  const hosted = options.edit !== undefined;
  root.classList.add("autocolor");
  root.classList.toggle("page", !hosted);
  root.classList.toggle("embed", !hosted && new URLSearchParams(location.search).has("embed"));
  const { lines, elements } = picture;
  const words = await unpackWords(picture.words, lines, elements);
  const before = words.slice();
  /** The words of the views that are inflated. @type {Words[]} */
  const rasters = [words];
  const { views } = picture;
  const entries = await entriesIn(picture);
  const key = picture.legend;
  const legend = key && (await unpackWords(key.words, key.lines, key.elements));
  const glass = glassOf(picture, words, entries, legend);
  const relight = await relighting(picture, words, glass.owner);
  const first = stateOf(picture);
  const turns = views.length ? "Drag the picture to turn it, or press the arrow keys. " : "";
  const hint = `${turns}Click a surface, and choose its paint.`;
  const status = make("p", { class: "status", role: "status" }, hint);

  /** @type {State[]} */
  let steps = [first];
  let at = 0;
  let gesture = "";
  let keyHeld = false;

  /** @type {Desk} */
  const desk = {
    id: `autocolor-${++mounted}`,
    picture,
    glass,
    first,
    state: first,
    chosen: Math.max(0, picture.surfaces.findIndex((surface) => !surface.fixed)),
    view: 0,
    syncs: [],
    say(text) {
      if (status.textContent !== text) status.textContent = text;
    },
    edit(edits, name = "") {
      const next = { ...desk.state, ...edits };
      if (alike(next, desk.state)) return;
      const sameStep = name !== "" && name === gesture;
      gesture = name;
      // What the host sent before is older than this edit.
      held = null;
      if (!hosted) {
        steps = steps.slice(0, sameStep ? at : at + 1).concat(next);
        at = steps.length - 1;
      }
      show(next);
      options.edit?.(edits, sameStep);
      if (!name) desk.rest();
    },
    rest() {
      if (keyHeld) return;
      gesture = "";
      if (!hosted) writeFragment();
      const show = held;
      held = null;
      show?.();
    },
    choose(number) {
      desk.chosen = number;
      sync();
      glass.drawOutline(number);
      pointed = -1;
      glass.outline.animate([{ opacity: 0.8 }, { opacity: 0.8, offset: 0.4 }, { opacity: 0 }], 1400);
    },
  };
  let shownWords = picture.words;
  /** What the host sent during a gesture, to be shown when it rests. @type {(() => void) | null} */
  let held = null;

  function sync() {
    desk.syncs.forEach((each) => each());
  }

  /** The numbers of the surfaces with a key of their paint among some keys. @param {string[]} keys */
  function paintedBy(keys) {
    return picture.surfaces.flatMap(({ name, fixed }, number) =>
      !fixed && PAINT.some((field) => keys.includes(`surfaces.${name}.${field}`)) ? [number] : [],
    );
  }

  /** Rewrite what differs: the entries of surfaces, or the words of the picture. */
  function show(/** @type {State} */ next) {
    const keys = differing(next, desk.state);
    desk.state = next;
    const light = lightIn(keys);
    const changed = light && relight ? relight(next, light) : 0;
    if (light && relight && desk.view === 0) {
      glass.look(glass.whole);
      desk.say(`${COUNT.format(changed)} words rewritten, no entry of the table: light is in the words.`);
    }
    const painted = paintedBy(keys);
    for (const number of painted) {
      const { name, levels, floor } = picture.surfaces[number];
      glass.rewrite(number, entriesOf(paintOf(next, name), levels, floor));
    }
    if (painted.length === 1 && !light) {
      const { first: from, levels } = picture.surfaces[painted[0]];
      desk.say(`Entries ${from} to ${from + levels - 1} of the table rewritten, no word of the picture.`);
    }
    sync();
  }

  function step(/** @type {number} */ by) {
    gesture = "";
    if (hosted) (by < 0 ? options.undo : options.redo)?.();
    else if (steps[at + by]) {
      at += by;
      show(steps[at]);
      desk.say(by < 0 ? "Undone." : "Redone.");
      writeFragment();
    }
  }

  function writeFragment() {
    const fragment = fragmentOf(desk.state, first, desk.view);
    if (location.hash.slice(1) === fragment) return;
    history.replaceState(history.state, "", fragment ? `#${fragment}` : location.pathname + location.search);
  }

  function readFragment() {
    const read = stateOfFragment(location.hash.slice(1), picture, first);
    if (typeof read === "string") return desk.say(read);
    desk.edit(read.state);
    turn(read.view);
  }

  // A page that turns: other views have other words, and the same table.

  /** The words of a view. @param {number} view */
  async function wordsOf(view) {
    return (rasters[view] ??= await unpackWords(views[view].words, lines, elements));
  }

  /** The view that was asked for last. */
  let asked = 0;

  /** Show a view; after the last comes the first again. @param {number} number */
  async function turn(number) {
    const view = ((number % views.length) + views.length) % views.length || 0;
    if (view === asked) return;
    asked = view;
    const next = await wordsOf(view);
    if (view !== asked) return;
    desk.view = view;
    const changed = glass.turn(next);
    // An outline that is fading away belongs to the view before.
    for (const fading of glass.outline.getAnimations()) fading.cancel();
    old?.turn(view ? next : before);
    point(-1);
    const { name } = views[view];
    desk.say(`View ${name}: ${COUNT.format(changed)} words rewritten, no entry of the table.`);
    sync();
    if (!from?.isDrag) writeFragment();
  }

  /** Inflate another view, the nearest first, whenever there is nothing else to do. */
  function inflate() {
    const half = views.length / 2;
    const turns = (/** @type {number} */ view) => (view - desk.view + 3 * half) % (2 * half);
    const away = (/** @type {number} */ view) => Math.abs(turns(view) - half);
    const left = [...views.keys()].filter((view) => !rasters[view]);
    const [view] = left.sort((one, other) => away(one) - away(other));
    if (view === undefined || life.signal.aborted) return;
    const idle = globalThis.requestIdleCallback ?? setTimeout;
    idle(() => wordsOf(view).then(inflate));
  }

  // The picture: point at a surface to see its name and outline, click to choose it.
  const label = make("span", { class: "pointed" });
  const screen = div("glass", glass.canvas, glass.outline, label);
  screen.style.setProperty("--ratio", String(elements / lines));
  screen.style.setProperty("--most", `${elements * (picture.smooth === 1 ? 1.6 : 1)}px`);
  root.style.setProperty("--background", picture.background);
  let pointed = -1;
  function point(/** @type {number} */ number) {
    if (number !== pointed && number >= 0) glass.drawOutline(number);
    pointed = number;
    label.textContent = number < 0 ? "" : picture.surfaces[number].name;
    screen.classList.toggle("pointing", number >= 0);
  }
  /** The number of the surface under the pointer. @param {MouseEvent} event */
  function surfaceAt(event) {
    const box = glass.canvas.getBoundingClientRect();
    const [line, element] = [event.clientY - box.top, event.clientX - box.left].map((each) =>
      Math.floor((each * elements) / box.width),
    );
    return (glass.owner[glass.words[line * elements + element]] ?? 0) - 1;
  }

  // Drag it sideways to turn it: the near side follows the pointer, a whole turn across the picture.
  /** Where a drag began, until it ends. @type {{x: number, view: number, isDrag: boolean} | null} */
  let from = null;
  let dragged = false;
  /** Where a button was pressed last. @type {[number, number]} */
  let pressed = [0, 0];
  const release = () => {
    dragged = from?.isDrag ?? false;
    from = null;
    if (dragged) writeFragment();
  };
  const listeners = {
    pointerdown(/** @type {PointerEvent} */ { isPrimary, button, clientX, clientY }) {
      dragged = false;
      pressed = [clientX, clientY];
      if (isPrimary && button === 0 && views.length) from = { x: clientX, view: asked, isDrag: false };
    },
    pointermove(/** @type {PointerEvent} */ event) {
      if (from && event.buttons) {
        const share = (event.clientX - from.x) / glass.canvas.clientWidth;
        if (!from.isDrag && Math.abs(event.clientX - from.x) > NEAR) {
          from.isDrag = true;
          glass.canvas.setPointerCapture(event.pointerId);
        }
        if (from.isDrag) turn(from.view - Math.round(share * views.length));
      } else if (event.pointerType === "mouse" && surfaceAt(event) !== pointed) point(surfaceAt(event));
    },
    pointerup: release,
    pointercancel: release,
    pointerleave: () => point(-1),
    click(/** @type {PointerEvent} */ event) {
      const moved = Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]);
      if (!dragged && moved <= NEAR && surfaceAt(event) >= 0) desk.choose(surfaceAt(event));
    },
  };
  for (const [name, listener] of Object.entries(listeners))
    glass.canvas.addEventListener(name, /** @type {EventListener} */ (listener));
  if (views.length) {
    screen.classList.add("turning");
    screen.append(
      square("Turn left", LEFT, () => turn(asked - 1), { class: "square turn" }),
      square("Turn right", RIGHT, () => turn(asked + 1), { class: "square turn right" }),
    );
  }

  const counts = () =>
    hosted ? [desk.picture.undo ?? 0, desk.picture.redo ?? 0] : [at, steps.length - 1 - at];
  /** The picture as exported, once it was compared. @type {ReturnType<typeof glassOf> | null} */
  let old = null;
  const compare = comparison(screen, () => {
    old = glassOf(picture, desk.view ? glass.words : before, entries, legend);
    return old.canvas;
  });
  const notes = div("notes", ...picture.notes.map((note) => make("p", {}, note)));
  const head = div("head", ...(hosted ? [] : [title(desk)]), toolbar(desk, step, counts, compare));
  const under = div("under", paints(desk), status, ...variantStrip(desk, relight, words), wholeTable(desk));
  const panel = div(
    "panel", surfaceList(desk), paintPanel(desk), ...lightRows(desk), notes, sharing(desk, hosted),
  );
  root.replaceChildren(
    make(hosted ? "div" : "main", { class: "desk" }, head, div("stage", screen), under, panel),
  );
  sync();

  // Keys and gestures: a drag, or a key that is held, is one step.
  const keys = hosted ? root : document;
  const life = new AbortController();
  const onKey = (/** @type {Event} */ event) => {
    const press = /** @type {KeyboardEvent} */ (event);
    const { key: name, shiftKey, target } = press;
    const isCommand = press.ctrlKey || press.metaKey;
    if (press.type === "keyup") {
      keyHeld = false;
      if (gesture) desk.rest();
      return;
    }
    const kind = target instanceof HTMLInputElement ? target.type : "";
    if (views.length && !kind && !isCommand && !press.altKey && /^Arrow(Left|Right)$/.test(name)) {
      press.preventDefault();
      turn(asked + (name === "ArrowLeft" ? -1 : 1));
    }
    keyHeld = kind === "range" && /^(Arrow|Page|Home|End)/.test(name);
    // In a text, these keys undo what was typed.
    const inText = kind === "text" || kind === "number";
    const letter = name.toLowerCase();
    if (!isCommand || press.altKey || inText || !(letter === "z" || letter === "y")) return;
    press.preventDefault();
    press.stopPropagation();
    step(letter === "y" || shiftKey ? 1 : -1);
  };
  const mortal = { signal: life.signal };
  keys.addEventListener("keydown", onKey, mortal);
  keys.addEventListener("keyup", onKey, mortal);
  root.addEventListener("change", desk.rest, mortal);
  if (!hosted) {
    addEventListener("hashchange", readFragment, mortal);
    if (location.hash.length > 1) readFragment();
  }
  inflate();

  return {
    /**
     * Show what a host sent; false if it needs a new interface. During a gesture, and as long as the host
     * has not heard of edits of some `keys`, controls stay; the paints with these keys stay, too.
     * @param {Picture} changed @param {string[]} keys
     */
    async update(changed, keys) {
      if (structureOf(changed) !== structureOf(picture)) return false;
      if (changed.words !== shownWords) {
        words.set(await unpackWords(changed.words, lines, elements));
        shownWords = changed.words;
        desk.say(`The studio sent ${COUNT.format(bytesOf(changed.words).length)} bytes of words.`);
      }
      const state = stateOf(changed);
      const showEntries = (/** @type {number[]} */ own) => {
        load(glass.table, 0, bytesOf(changed.entries));
        for (const { name, first, levels, floor } of own.map((number) => changed.surfaces[number])) {
          load(glass.table, first, entriesOf(paintOf(desk.state, name), levels, floor));
        }
        glass.look(glass.whole);
      };
      const take = () => {
        showEntries([]);
        picture = desk.picture = changed;
        desk.state = state;
        sync();
      };
      if (keys.length === 0) held = take;
      if (keys.length > 0 || gesture || keyHeld) showEntries(paintedBy(keys));
      else desk.rest();
      return true;
    },
    say: desk.say,
    destroy() {
      life.abort();
      root.replaceChildren();
    },
  };
}

/** A button with an icon. @param {string} label @param {string} path @param {() => unknown} onclick
 * @param {Record<string, unknown>} [more] */
function square(label, path, onclick, more) {
  return make("button", { class: "square", "aria-label": label, onclick, ...more }, icon(path));
}

/** The name of the picture, and what a paint changes. @param {Desk} desk */
function title(desk) {
  const { line = "", link } = desk.picture;
  const name = desk.picture.name || "autocolor";
  const home = link && make("a", { href: link, target: "_blank", rel: "noopener" }, name);
  const text = make("p");
  desk.syncs.push(() => {
    const { levels = 0, fixed = true } = desk.picture.surfaces[desk.chosen] ?? {};
    text.textContent = fixed ? `${line.split(";")[0]}.` : line.replace("{}", COUNT.format(levels));
  });
  return div("title", make("h1", {}, home || name), text);
}

/** Named paints for the chosen surface, and a random paint. @param {Desk} desk */
function paints(desk) {
  const group = make("div", { class: "paints", role: "group" });
  const chosen = () => desk.picture.surfaces[desk.chosen] ?? { name: "", fixed: "none" };
  const key = (/** @type {string} */ field) => `surfaces.${chosen().name}.${field}`;
  const recolor = (/** @type {Partial<Paint>} */ paint) =>
    desk.edit(Object.fromEntries(Object.entries(paint).map(([field, value]) => [key(field), value])));
  const buttons = Object.entries(desk.picture.swatches).map(([name, color]) => {
    const ball = make("span", { class: "ball" });
    ball.style.background = `radial-gradient(circle at 36% 30%, #fff, ${color} 45%)`;
    const onclick = () => recolor({ object_color: color, ramp: null });
    const button = make("button", { onclick }, ball, make("span", {}, name));
    desk.syncs.push(() => {
      const isPaint = desk.state[key("ramp")] === null && desk.state[key("object_color")] === color;
      button.ariaPressed = String(isPaint);
    });
    return button;
  });
  const random = (least = 0, most = 0) => least + Math.random() * (most - least);
  const surprise = () => {
    const hue = random(0, 360);
    recolor({
      ramp: null,
      object_color: cssColor(`hsl(${hue} ${random(30, 95)}% ${random(15, 60)}%)`),
      light_color: cssColor(`hsl(${hue + random(-90, 90)} ${random(20, 100)}% ${random(80, 95)}%)`),
      blend: Math.round(random(25, 80)) / 100,
    });
  };
  group.append(...buttons, make("button", { class: "surprise", onclick: surprise }, "Surprise me"));
  desk.syncs.push(() => {
    group.hidden = chosen().fixed !== "";
    group.ariaLabel = `Paints for ${chosen().name}`;
  });
  return group;
}

/** The buttons above the picture. @param {Desk} desk @param {(by: number) => void} step
 * @param {() => number[]} counts  The steps to undo and to redo. @param {HTMLElement} compare */
function toolbar(desk, step, counts, compare) {
  const [undo, redo] = [
    ["Undo", "Ctrl+Z", UNDO],
    ["Redo", "Ctrl+Y", REDO],
  ].map(([label, keys, path], which) =>
    square(label, path, () => step(2 * which - 1), { title: `${label} (${keys})` }),
  );
  const reset = make("button", { onclick: () => desk.edit(changesTo(desk, desk.first)) }, "Reset");
  desk.syncs.push(() => {
    const [undos, redos] = counts();
    // A disabled button would lose the focus.
    undo.ariaDisabled = String(undos === 0);
    redo.ariaDisabled = String(redos === 0);
    reset.ariaDisabled = String(alike(desk.state, desk.first));
  });
  return div("tools", undo, redo, compare, reset);
}

/** The edits that lead to other values. @param {Desk} desk @param {State} state @returns {State} */
function changesTo(desk, state) {
  return Object.fromEntries(differing(state, desk.state).map((key) => [key, state[key]]));
}

/** The button that shows the picture as it was on the left of a line, which can be dragged.
 * @param {HTMLElement} screen @param {() => HTMLCanvasElement} drawBefore */
function comparison(screen, drawBefore) {
  /** @type {HTMLElement[]} */
  let shown = [];
  const onclick = () => {
    const isOn = shown.length === 0;
    button.ariaPressed = String(isOn);
    shown.forEach((each) => each.remove());
    shown = isOn ? split() : [];
    screen.append(...shown);
  };
  const attributes = { "aria-pressed": "false", title: "Show the picture as it was, left of a line", onclick };
  const button = make("button", attributes, icon(COMPARE), "Before");
  function split() {
    const before = drawBefore();
    before.className = "before";
    before.ariaHidden = "true";
    const move = () => screen.style.setProperty("--split", `${line.value}%`);
    const line = make("input", {
      type: "range", class: "split", min: 0, max: 100, step: 0.5, value: 50,
      "aria-label": "Line between before and after", oninput: move,
    });
    move();
    return [before, make("span", { class: "line" }), line];
  }
  return button;
}

/** The surfaces, one of which is chosen. @param {Desk} desk */
function surfaceList(desk) {
  const rows = desk.picture.surfaces.map(({ name }, number) => {
    const radio = make("input", {
      type: "radio",
      name: `${desk.id}-surface`,
      value: number,
      onchange: () => desk.choose(number),
    });
    const ball = make("span", { class: "ball" });
    desk.syncs.push(() => {
      radio.checked = desk.chosen === number;
      ball.style.background = ballOf(desk, number);
    });
    return make("label", { class: "chip" }, radio, ball, make("span", {}, name));
  });
  return make("fieldset", { class: "surfaces" }, make("legend", {}, "Surface"), div("chips", ...rows));
}

/**
 * A ball in the colors of a surface; stripes for bands of a scalar.
 * @param {Desk} desk @param {number} number
 */
function ballOf({ picture, glass }, number) {
  const { first, levels, shades } = picture.surfaces[number];
  const at = (/** @type {number} */ share) => {
    const color = glass.table[first + Math.round(share * (levels - 1))];
    return inDigits([color & 255, (color >> 8) & 255, (color >> 16) & 255]);
  };
  if (shades !== levels) return `linear-gradient(90deg, ${[0.05, 0.3, 0.55, 0.8, 1].map(at).join(", ")})`;
  return `radial-gradient(circle at 36% 30%, ${at(1)} 4%, ${at(0.8)} 22%, ${at(0.55)} 58%, ${at(0.2)})`;
}

/** The colors of the chosen surface. @param {Desk} desk */
function paintPanel(desk) {
  const panel = make("section", { class: "paint" });
  /** @type {Array<() => void>} */
  let syncs = [];
  let field = "object_color";
  let built = "";
  desk.syncs.push(() => {
    const { name, first, levels, fixed } = desk.picture.surfaces[desk.chosen] ?? {};
    if (name === undefined) return;
    const isRamp = desk.state[`surfaces.${name}.ramp`] !== null;
    const needed = JSON.stringify([desk.chosen, isRamp, field]);
    if (needed !== built) {
      built = needed;
      syncs = [];
      const range = make("small", {}, `entries ${first} to ${first + levels - 1}`);
      const heading = make("h2", {}, make("span", {}, name), range);
      const controls = fixed
        ? [strip(desk, syncs), make("p", { class: "fixed" }, fixed)]
        : isRamp
          ? ramp()
          : twoColors();
      panel.replaceChildren(heading, ...controls);
    }
    syncs.forEach((each) => each());
  });

  function ramp() {
    const key = `surfaces.${desk.picture.surfaces[desk.chosen].name}`;
    const colors = /** @type {string[]} */ (desk.state[`${key}.ramp`]);
    const replace = () =>
      desk.edit({
        [`${key}.ramp`]: null,
        [`${key}.object_color`]: colors[colors.length >> 1],
        [`${key}.light_color`]: colors[colors.length - 1],
      });
    return [
      strip(desk, syncs),
      make("p", { class: "fixed" }, `A ramp of ${colors.length} colors, from the lowest level up.`),
      make("button", { onclick: replace }, "Use two colors instead"),
    ];
  }

  function twoColors() {
    const { name } = desk.picture.surfaces[desk.chosen];
    const key = (/** @type {string} */ each) => `surfaces.${name}.${each}`;
    const tabs = [["object_color", "Object color"], ["light_color", "Light color"]].map(([each, label]) => {
      const radio = make("input", {
        type: "radio",
        name: `${desk.id}-color`,
        value: each,
        onchange: () => chooseField(each),
      });
      radio.checked = each === field;
      const swatch = make("span", { class: "swatch" });
      syncs.push(() => (swatch.style.background = String(desk.state[key(each)])));
      return make("label", {}, radio, swatch, label);
    });
    const blend = slider(desk, syncs, {
      label: "Blend", title: `Blend of ${name}: where the light color begins`, max: 1, step: 0.01,
      key: key("blend"),
    });
    const percentage = slider(desk, syncs, {
      label: "Light %", title: `Percent of the light color at the highest level of ${name}`, max: 100,
      step: 1, key: key("light_percentage"),
    });
    blend.firstElementChild?.nextElementSibling?.before(strip(desk, syncs));
    blend.classList.add("blend");
    return [
      make("fieldset", { class: "tabs" }, make("legend", {}, `Colors of ${name}`), ...tabs),
      ...mixer(desk, syncs, key(field), `${field === "object_color" ? "object" : "light"} color of ${name}`),
      div("blending", blend, percentage),
    ];
  }

  function chooseField(/** @type {string} */ each) {
    field = each;
    desk.syncs.forEach((sync) => sync());
    /** @type {HTMLElement | null} */ (panel.querySelector(`[value="${each}"]`))?.focus();
  }
  return panel;
}

/**
 * The entries of the chosen surface, from the lowest level to the highest.
 * @param {Desk} desk @param {Array<() => void>} syncs
 */
function strip(desk, syncs) {
  const { first, levels } = desk.picture.surfaces[desk.chosen];
  const canvas = make("canvas", { class: "strip", width: levels, height: 1 });
  syncs.push(() => drawPixels(canvas, desk.glass.table.subarray(first, first + levels)));
  return canvas;
}

/** Draw pixels on a whole canvas. @param {HTMLCanvasElement} canvas @param {Uint32Array} pixels */
function drawPixels(canvas, pixels) {
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const image = context.createImageData(canvas.width, canvas.height);
  new Uint32Array(image.data.buffer).set(pixels);
  context.putImageData(image, 0, 0);
}

/**
 * A slider with its number.
 * @param {Desk} desk @param {Array<() => void>} syncs
 * @param {{label: string, title: string, max: number, step: number, key?: string, value?: () => number,
 *   edits?: (value: number) => State, track?: () => string}} spec
 */
function slider(desk, syncs, { label, title, max, step, key = "", track, ...spec }) {
  const { value = () => Number(desk.state[key]), edits = (each) => ({ [key]: each }) } = spec;
  const take = (/** @type {Event} */ event) => {
    const text = /** @type {HTMLInputElement} */ (event.target).value;
    const number = Math.min(Math.max(Number(text), 0), max);
    if (text !== "" && Number.isFinite(number)) desk.edit(edits(number), title);
  };
  const range = make("input", {
    type: "range", min: 0, max, step, "aria-label": title, title, oninput: take,
  });
  const digits = make("input", {
    type: "number",
    min: 0,
    max,
    step,
    "aria-label": `${title}, as a number`,
    oninput: take,
    onchange: () => (digits.value = shownNumber(value())),
  });
  syncs.push(() => {
    const text = String(value());
    if (range.value !== text) range.value = text;
    if (!digits.matches(":focus")) digits.value = shownNumber(value());
    if (track) range.style.setProperty("--track", track());
  });
  return div("slider", make("span", { class: "name", "aria-hidden": "true" }, label), range, digits);
}

/** A number in at most three decimals. @param {number} value */
function shownNumber(value) {
  return String(Math.round(value * 1000) / 1000);
}

/**
 * The controls that mix a color.
 * @param {Desk} desk @param {Array<() => void>} syncs @param {string} key @param {string} what
 */
function mixer(desk, syncs, key, what) {
  const color = () => colorOf(String(desk.state[key]));
  const picker = make("input", {
    type: "color",
    "aria-label": `Pick the ${what}`,
    oninput: () => desk.edit({ [key]: picker.value }, `pick ${key}`),
  });
  const text = make("input", {
    type: "text",
    spellcheck: "false",
    autocomplete: "off",
    "aria-label": `The ${what} as #rrggbb or a name of CSS`,
    onchange: take,
    // JupyterLab takes Enter for itself, and then nothing changes.
    onkeydown: (/** @type {KeyboardEvent} */ press) => press.key === "Enter" && take(),
  });
  function take() {
    const digits = cssColor(text.value);
    text.toggleAttribute("aria-invalid", !digits);
    if (digits) desk.edit({ [key]: digits });
    else desk.say(`A color must be “#rrggbb”, or a name such as “navy”, not “${text.value.slice(0, 40)}”.`);
    if (digits) text.value = digits;
  }
  syncs.push(() => {
    const digits = String(desk.state[key]);
    picker.value = digits;
    if (!text.matches(":focus")) {
      text.value = digits;
      text.removeAttribute("aria-invalid");
    }
  });
  const parts = ["Red", "Green", "Blue"].map((label, part) => {
    const mixed = (/** @type {number} */ each) =>
      inDigits(color().map((own, at) => (at === part ? Math.round(each) : own)));
    return slider(desk, syncs, {
      label: label[0],
      title: `${label} of the ${what}`,
      max: 255,
      step: 1,
      value: () => color()[part],
      edits: (each) => ({ [key]: mixed(each) }),
      track: () => `linear-gradient(90deg, ${mixed(0)}, ${mixed(255)})`,
    });
  });
  const white = slider(desk, syncs, {
    label: "W",
    title: `White of the ${what}: all three parts at once`,
    max: 255,
    step: 1,
    value: () => whiteOf(color()),
    edits: (each) => ({ [key]: inDigits(withWhite(color(), each)) }),
    track: () => `linear-gradient(90deg, #000, ${inDigits(withWhite(color(), 128))}, #fff)`,
  });
  return [div("mixed", picker, text), div("bars", ...parts, white)];
}

/**
 * The switches and strengths of the lights, if any. They rest in other views than the first.
 * @param {Desk} desk
 */
function lightRows(desk) {
  const lights = desk.picture.lights;
  if (!lights) return [];
  const rows = lights.rows.map(({ name, most }) => {
    const key = `lights.${name}.on`;
    const toggle = make("input", {
      type: "checkbox",
      role: "switch",
      "aria-label": `Light ${name}`,
      onchange: () => desk.edit({ [key]: toggle.checked }),
    });
    desk.syncs.push(() => (toggle.checked = desk.state[key] === true));
    const strength = slider(desk, desk.syncs, {
      label: "", title: `Strength of light ${name}`, max: most, step: most / 200,
      key: `lights.${name}.intensity`,
    });
    return div("light", make("label", {}, toggle, make("span", {}, name)), strength);
  });
  const box = make("fieldset", {}, ...rows);
  const why = make("p", { class: "fixed" });
  desk.syncs.push(() => {
    box.disabled = desk.view > 0;
    why.textContent = desk.view > 0 ? RESTING : lights.held;
  });
  return [make("section", { class: "lights" }, make("h2", {}, "Lights"), box, why)];
}

const RESTING = "Lights can be changed in the first view only: the page has their planes for no other.";

/** The whole lookup table, with the range of the chosen surface, behind a fold. @param {Desk} desk */
function wholeTable(desk) {
  const canvas = make("canvas", { width: ENTRIES, height: 1 });
  const mark = make("span", { class: "mark" });
  desk.syncs.push(() => {
    drawPixels(canvas, desk.glass.table);
    const { first, levels } = desk.picture.surfaces[desk.chosen] ?? { first: 0, levels: 0 };
    mark.style.left = `${(100 * first) / ENTRIES}%`;
    mark.style.width = `${(100 * levels) / ENTRIES}%`;
  });
  const summary = make("summary", {}, "Lookup table, 1,024 entries");
  return make("details", { class: "table" }, summary, div("entries", canvas, mark));
}

/**
 * The pictures of the variants, which are drawn when they are scrolled into view. To choose one is one step.
 * @param {Desk} desk @param {((state: State, name: string) => number) | null} relight
 * @param {Words} words  Those of the first view.
 */
function variantStrip(desk, relight, words) {
  const { picture, first } = desk;
  if (picture.variants.length === 0) return [];
  const draw = new Map();
  const observer = new IntersectionObserver((seen) => {
    for (const { isIntersecting, target } of seen) {
      if (!isIntersecting) continue;
      observer.unobserve(target);
      draw.get(target)();
    }
  });
  const buttons = [{ name: "As exported", values: {} }, ...picture.variants].map(({ name, values }) => {
    const state = { ...first, ...values };
    const canvas = make("canvas");
    draw.set(canvas, () => {
      const light = lightIn(differing(state, desk.state));
      if (light) relight?.(state, light);
      drawThumbnail(canvas, desk, state, words);
      if (light) relight?.(desk.state, light);
    });
    observer.observe(canvas);
    const onclick = () => desk.edit(changesTo(desk, state));
    const button = make("button", { onclick }, canvas, make("span", {}, name));
    desk.syncs.push(() => (button.ariaPressed = String(alike(state, desk.state))));
    return button;
  });
  return [make("div", { class: "variants", role: "group", "aria-label": "Variants" }, ...buttons)];
}

const THUMBNAIL = 208;

/**
 * Draw some of the picture's words in other colors.
 * @param {HTMLCanvasElement} canvas @param {Desk} desk @param {State} state @param {Words} words
 */
function drawThumbnail(canvas, { picture, glass }, state, words) {
  const { lines, elements, surfaces } = picture;
  const every = Math.max(1, Math.ceil(elements / THUMBNAIL));
  const width = (canvas.width = Math.floor(elements / every));
  canvas.height = Math.floor(lines / every);
  const table = glass.table.slice();
  for (const { name, first, levels, floor, fixed } of surfaces) {
    if (!fixed) load(table, first, entriesOf(paintOf(state, name), levels, floor));
  }
  const colors = Uint32Array.from(
    { length: width * canvas.height },
    (_, at) => table[words[(Math.floor(at / width) * elements + (at % width)) * every]],
  );
  drawPixels(canvas, colors);
}

/**
 * The buttons that copy the link, and save the picture and its values.
 * @param {Desk} desk @param {boolean} hosted
 */
function sharing(desk, hosted) {
  const { picture, glass, first } = desk;
  const stem = picture.name.replace(/[^\p{L}\p{N}._-]+/gu, "-") || "picture";
  const button = (/** @type {string} */ text, /** @type {() => void} */ onclick) =>
    make("button", { onclick }, text);
  async function copy(/** @type {string} */ text) {
    try {
      await navigator.clipboard.writeText(text);
      desk.say("Copied, with these colors.");
    } catch {
      desk.say("The browser did not allow it; a link of the address bar has these colors, too.");
    }
  }
  function copyEmbedded() {
    const url = new URL(location.href);
    url.searchParams.set("embed", "1");
    const source = url.href.replaceAll("&", "&amp;");
    copy(`<iframe src="${source}" title="A picture to recolor" width="640" height="600"></iframe>`);
  }
  const hasAddress = location.protocol.startsWith("http");
  function savePicture() {
    const image = averaged(glass.pixels, picture.elements, picture.smooth);
    const canvas = make("canvas", { width: image.width, height: image.height });
    canvas.getContext("2d")?.putImageData(image, 0, 0);
    canvas.toBlob((blob) => blob && download(blob, `${stem}.png`));
  }
  function saveValues() {
    const table = tableOf(desk.state, first, picture);
    download(new Blob([table], { type: "text/csv" }), `${stem}-values.csv`);
    if (/^[^\n]*,exposure\r\n/.test(table))
      desk.say("The lights differ, so the table also holds the exposure for autocolor sweep.");
  }
  return div(
    "sharing",
    ...(hosted ? [] : [button("Copy link", () => copy(location.href))]),
    ...(hosted || !hasAddress ? [] : [button("Copy embed code", copyEmbedded)]),
    button("Save PNG", savePicture),
    button("Save CSV", saveValues),
  );
}

/** Save a file from the page. @param {Blob} blob @param {string} name */
function download(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

// For notebooks: a page has only what is above this line.

/** Milliseconds until a studio counts as busy. */
const PATIENCE = 3000;

/** The widget of a notebook, as anywidget asks for it. Its host is a studio; see `notebook.py`. */
export default {
  /** @param {{model: any, el: HTMLElement}} context */
  async render({ model, el }) {
    /** The messages that the studio has not answered; only the first is sent. @type {any[]} */
    const messages = [];
    /** The traits that changed since they were shown. @type {Set<string>} */
    const changed = new Set();
    let isLate = false;
    const shape = () => structureOf(model.get("picture"));

    function send(/** @type {any} */ message) {
      const last = messages.length > 1 ? messages[messages.length - 1] : {};
      if (message.same_step && last.edit) Object.assign(last.edit, message.edit);
      else if (messages.push(message) === 1) sendFirst();
    }

    function sendFirst() {
      const [message] = messages;
      if (!message) return;
      setTimeout(() => {
        if (message !== messages[0]) return;
        isLate = true;
        handle.say("The studio has not answered yet: its kernel is busy, or gone.");
      }, PATIENCE);
      try {
        model.send(message);
      } catch {
        messages.length = 0;
        handle.say("The kernel of the notebook is gone, so edits do not reach the studio.");
      }
    }

    /** Show what the studio sent. It has not heard of the edits that wait for answers. */
    function show() {
      if (changed.size === 0) return;
      const keys = shape() === shown ? messages.flatMap(({ edit }) => Object.keys(edit ?? {})) : [];
      const news = Object.fromEntries([...changed].map((name) => [name, model.get(name)]));
      if (keys.length === 0) changed.clear();
      changed.delete("words");
      shown = shape();
      handle.update(news, keys);
    }

    function hear(/** @type {any} */ message) {
      if (typeof message?.answer !== "string" || messages.length === 0) return;
      const answered = messages.shift();
      sendFirst();
      if (message.answer) changed.add("picture");
      show();
      if (message.answer) handle.say(message.answer);
      else if (answered.undo || answered.redo) handle.say(answered.undo ? "Undone." : "Redone.");
      else if (isLate) handle.say("The studio has answered.");
      isLate = false;
    }

    // JupyterLab takes no key as a shortcut from an element with this attribute; otherwise "b" would insert a
    // cell.
    el.addEventListener(
      "focusin",
      ({ target }) => target instanceof HTMLElement && (target.dataset.lmSuppressShortcuts = "true"),
    );
    const traits = ["picture", "words", "entries"];
    const [picture, words, entries] = traits.map((name) => model.get(name));
    let shown = shape();
    const handle = await mount(
      el,
      { ...picture, words, entries },
      {
        edit: (edits, sameStep) => send({ edit: edits, same_step: sameStep }),
        undo: () => send({ undo: 1 }),
        redo: () => send({ redo: 1 }),
      },
    );
    const listeners = traits.map((name) => () => {
      changed.add(name);
      queueMicrotask(show);
    });
    traits.forEach((name, at) => model.on(`change:${name}`, listeners[at]));
    model.on("msg:custom", hear);
    return () => {
      traits.forEach((name, at) => model.off(`change:${name}`, listeners[at]));
      model.off("msg:custom", hear);
      handle.destroy();
    };
  },
};
