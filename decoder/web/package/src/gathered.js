/** Returns values at places, each of `width` numbers. into: an array to fill, if it fits. */
export function gathered(values, places, width, into) {
  const Type = values.constructor;
  const length = width * places.length;
  const out = into?.length === length && into instanceof Type ? into : new Type(length);
  for (let i = 0; i < places.length; ++i) {
    const from = width * places[i];
    const to = width * i;
    for (let c = 0; c < width; ++c) out[to + c] = values[from + c];
  }
  return out;
}
