// Shaders. Light is linear until the last line.

const kVersion = "#version 300 es\nprecision highp float;\n";

/** Ramp of colours from 0 to 1, in CSS, for legends and for the surface. */
export const kRamp =
  [[217, 222, 229], [250, 215, 110], [241, 140, 56], [207, 43, 74], [104, 22, 125]];

export const kRampCss = `linear-gradient(to right, ${kRamp.map((c) => `rgb(${c})`).join(", ")})`;

const kRampColour = `
  vec3 rampColour(float share) {
    const vec3 ramp[5] = vec3[5](${kRamp.map((c) => `vec3(${c.map((v) => `${v}.0`)}) / 255.0`)});
    float at = 4.0 * clamp(share, 0.0, 1.0);
    int left = min(int(at), 3);
    return pow(mix(ramp[left], ramp[left + 1], at - float(left)), vec3(2.2));
  }`;

// Part of the light that reaches a place: the mean of 3 x 3 samples of the map.
const kLit = `
  uniform highp sampler2DShadow shadowMap;
  uniform bool hasShadow;
  float lit(vec4 place) {
    if (!hasShadow) return 1.0;
    vec3 at = 0.5 + 0.5 * place.xyz;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        sum += texture(shadowMap, at + vec3(vec2(x, y) * 1.4 / 2048.0, 0.0));
      }
    }
    return sum / 9.0;
  }`;

// Filmic: bright colours lose saturation instead of being clipped (the ACES fit of S. Hill).
const kToneMap = `
  vec3 toneMapped(vec3 light) {
    const mat3 input_ = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383,
                             0.04823, 0.01566, 0.83777);
    const mat3 output_ = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276,
                              -0.07367, -0.00605, 1.07602);
    vec3 v = input_ * (light / 0.6);
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return pow(clamp(output_ * v, 0.0, 1.0), vec3(1.0 / 2.2));
  }`;

export const kSurface = {
  vertex: `${kVersion}
  in vec3 position; in vec3 normal; in float deviation; in vec4 tint;
  in vec2 uv; in vec2 normalUv; in vec2 emissionUv;
  uniform mat4 model; uniform mat4 camera; uniform mat4 light;
  uniform vec3 row0; uniform vec3 row1; uniform vec3 normalRow0; uniform vec3 normalRow1;
  uniform vec3 emissionRow0; uniform vec3 emissionRow1;
  out vec3 world; out vec3 turned; out vec4 lightPlace; out float distant; out vec4 tinted;
  out vec2 at; out vec2 normalAt; out vec2 emissionAt;
  void main() {
    at = vec2(dot(row0, vec3(uv, 1.0)), dot(row1, vec3(uv, 1.0)));
    normalAt = vec2(dot(normalRow0, vec3(normalUv, 1.0)), dot(normalRow1, vec3(normalUv, 1.0)));
    emissionAt = vec2(dot(emissionRow0, vec3(emissionUv, 1.0)),
                      dot(emissionRow1, vec3(emissionUv, 1.0)));
    tinted = tint;
    vec4 place = model * vec4(position, 1.0);
    world = place.xyz;
    turned = mat3(model) * normal;
    lightPlace = light * place;
    distant = deviation;
    gl_Position = camera * place;
    gl_PointSize = 4.0;
  }`,
  fragment: `${kVersion}
  in vec3 world; in vec3 turned; in vec4 lightPlace; in float distant; in vec4 tinted;
  in vec2 at; in vec2 normalAt; in vec2 emissionAt;
  uniform sampler2D basePicture; uniform sampler2D normalPicture; uniform sampler2D emissionPicture;
  uniform vec4 base; uniform vec3 emission; uniform float normalScale; uniform bool hasNormalMap;
  uniform float cutoff; uniform bool blends;
  uniform vec3 eye; uniform vec3 keyDirection; uniform vec3 rimDirection;
  uniform bool flatShading; uniform bool isPoint; uniform float deviationScale;
  out vec4 colour;
  ${kRampColour} ${kLit} ${kToneMap}
  // n, facing the eye, tilted by the normal map. Tangents come from screen-space derivatives, as
  // streams have none; +y of the map is up in the image.
  vec3 bent(vec3 n) {
    vec3 x = dFdx(world), y = dFdy(world);
    vec2 s = dFdx(normalAt), t = dFdy(normalAt);
    vec3 acrossY = cross(y, n), acrossX = cross(n, x);
    vec3 right = acrossY * s.x + acrossX * t.x;
    vec3 down = acrossY * s.y + acrossX * t.y;
    float size = max(dot(right, right), dot(down, down));
    if (size == 0.0) return n;
    vec3 map = 2.0 * texture(normalPicture, normalAt).xyz - 1.0;
    map.xy *= normalScale * inversesqrt(size) * (gl_FrontFacing ? 1.0 : -1.0);
    return normalize(right * map.x - down * map.y + n * map.z);
  }
  void main() {
    vec4 own = base * tinted * texture(basePicture, at);
    if (own.a < cutoff) discard;
    vec3 towards = normalize(eye - world);
    vec3 n = gl_FrontFacing ? turned : -turned;
    if (flatShading || dot(n, n) == 0.0) {
      n = cross(dFdx(world), dFdy(world));
      if (dot(n, towards) < 0.0) n = -n;
    }
    n = isPoint ? towards : normalize(n);
    if (hasNormalMap) n = bent(n);
    bool showsDistance = deviationScale > 0.0;
    vec3 albedo = showsDistance ? rampColour(distant / deviationScale) : own.rgb;
    vec3 glow = showsDistance ? vec3(0.0) : emission * texture(emissionPicture, emissionAt).rgb;
    vec4 biased = vec4(lightPlace.xyz - vec3(0.0, 0.0, 0.004), 1.0);
    float key = max(dot(n, keyDirection), 0.0);
    if (key > 0.0) key *= lit(biased);
    float rim = max(dot(n, rimDirection), 0.0);
    vec3 sky = mix(vec3(0.038, 0.029, 0.022), vec3(0.24, 0.28, 0.33), 0.5 + 0.5 * n.y);
    vec3 light = sky + 0.99 * key * vec3(1.0, 0.87, 0.70) + 0.5 * rim * vec3(0.35, 0.55, 1.0);
    float shine = pow(max(dot(n, normalize(towards + keyDirection)), 0.0), 24.0);
    float opacity = blends ? own.a : 1.0;
    colour = vec4(toneMapped(albedo * light + glow + 0.03 * shine * key) * opacity, opacity);
  }`,
};

export const kDepth = {
  vertex: `${kVersion}
  in vec3 position; uniform mat4 model; uniform mat4 light;
  void main() { gl_Position = light * (model * vec4(position, 1.0)); }`,
  fragment: `${kVersion} void main() {}`,
};

// Draws edges in front of the surface, so that it does not hide them.
export const kEdges = {
  vertex: `${kVersion}
  in vec3 position; uniform mat4 model; uniform mat4 camera;
  void main() {
    gl_Position = camera * (model * vec4(position, 1.0));
    gl_Position.z -= 3e-4 * gl_Position.w;
  }`,
  fragment: `${kVersion}
  uniform vec4 ink; out vec4 colour;
  void main() { colour = vec4(ink.rgb * ink.a, ink.a); }`,
};

// Draws a grid that fades out, and the shadow on it.
export const kFloor = {
  vertex: `${kVersion}
  in vec2 corner; uniform vec3 centre; uniform mat4 camera; uniform mat4 light;
  out vec2 place; out vec2 fromCentre; out vec4 lightPlace;
  void main() {
    vec4 world = vec4(centre + 6.0 * vec3(corner.x, 0.0, corner.y), 1.0);
    place = world.xz;
    fromCentre = 6.0 * corner;
    lightPlace = light * world;
    gl_Position = camera * world;
  }`,
  fragment: `${kVersion}
  in vec2 place; in vec2 fromCentre; in vec4 lightPlace;
  out vec4 colour;
  ${kLit}
  float lines(float spacing) {
    vec2 p = place / spacing;
    vec2 nearest = abs(fract(p - 0.5) - 0.5) / fwidth(p);
    return 1.0 - min(min(nearest.x, nearest.y), 1.0);
  }
  void main() {
    float fade = exp(-0.9 * dot(fromCentre, fromCentre));
    float ink = fade * max(0.2 * lines(0.1), 0.4 * lines(0.5));
    float shadow = 0.4 * (1.0 - lit(lightPlace));
    colour = vec4(vec3(0.52, 0.57, 0.63) * ink * (1.0 - shadow), ink + shadow - ink * shadow);
  }`,
};
