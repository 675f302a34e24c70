// Colours a surface by its distance from a reference, on the graphics card.

// The colours of .ramp in page.css.
const kRamp = `
  vec3 deviationColour(float share) {
    const vec3 ramp[5] = vec3[5](vec3(0.034, 0.091, 0.258), vec3(0.050, 0.386, 0.352),
      vec3(0.578, 0.672, 0.144), vec3(0.871, 0.352, 0.045), vec3(0.624, 0.042, 0.025));
    float at = 4.0 * clamp(share, 0.0, 1.0);
    int left = min(int(at), 3);
    return mix(ramp[left], ramp[left + 1], at - float(left));
  }`;

/** Returns the uniform with the distance of the last colour; 0 leaves the surface alone. */
export function paintDeviation(material) {
  const scale = { value: 0 };
  material.onBeforeCompile = (shader) => {
    shader.uniforms.deviationScale = scale;
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>",
        "#include <common>\nattribute float deviation;\nvarying float vDeviation;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvDeviation = deviation;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>",
        `#include <common>\nuniform float deviationScale;\nvarying float vDeviation;${kRamp}`)
      .replace("#include <color_fragment>", `#include <color_fragment>
        if (deviationScale > 0.0) {
          diffuseColor.rgb = deviationColour(vDeviation / deviationScale);
        }`);
  };
  return scale;
}
