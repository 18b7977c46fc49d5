"""The shaders of the OpenGL peer, GLSL 4.00; those that compute light want LIGHTS and SURFACES defined."""

from __future__ import annotations

MESH_VERTEX = """
#version 400
uniform mat4 projection;
in vec3 place;
in vec3 normal;
in float surface;
out vec3 point, direction;
flat out float number;
void main() {
    gl_Position = projection * vec4(place, 1.0);
    point = place;
    number = surface;
    direction = normal;
}
"""

MESH_FRAGMENT = """
#version 400
in vec3 point, direction;
flat in float number;
layout(location = 0) out vec4 seen_point;   // A point of the world, and the number of its surface.
layout(location = 1) out vec4 seen_normal;
void main() {
    seen_point = vec4(point, number);
    seen_normal = vec4(normalize(gl_FrontFacing ? direction : -direction), 0.0);
}
"""

WHOLE_VERTEX = """
#version 400
// One triangle that covers the picture, at the far plane: with depth test GREATER it leaves the background.
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 1.0, 1.0);
}
"""

LIGHT_FRAGMENT = """
uniform sampler2D points, normals;
uniform vec3 eye;
uniform vec3 reflectances[SURFACES];    // D, S, N
uniform vec3 positions[LIGHTS], axes[LIGHTS];
uniform vec3 controls[LIGHTS];          // Intensity, concentration, the least cosine to the axis
layout(location = 0) out float planes[LIGHTS];
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 point = texelFetch(points, pixel, 0);
    vec3 normal = texelFetch(normals, pixel, 0).xyz;
    vec3 reflectance = reflectances[int(point.w)];
    vec3 mirrored = reflect(normalize(point.xyz - eye), normal);
    for (int k = 0; k < LIGHTS; k++) {
        vec3 toward = normalize(positions[k] - point.xyz);
        float cos_incidence = dot(normal, toward);
        float cos_light = -dot(axes[k], toward);
        float light = 0.0;
        if (cos_incidence > 0.0 && cos_light > controls[k].z) {
            float cos_eye = max(dot(mirrored, toward), 1e-6);
            light = controls[k].x
                * (reflectance.x * cos_incidence + reflectance.y * pow(cos_eye, reflectance.z));
            if (controls[k].y > 0.0)
                light *= pow(cos_light, controls[k].y);
        }
        planes[k] = light;
    }
}
"""

COLOR_FRAGMENT = """
uniform sampler2D points;
uniform sampler2D planes[LIGHTS];
uniform float ambient;
uniform vec3 colors[SURFACES];
layout(location = 0) out vec4 color;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float light = ambient;
    for (int k = 0; k < LIGHTS; k++)
        light += texelFetch(planes[k], pixel, 0).x;
    color = vec4(light * colors[int(texelFetch(points, pixel, 0).w)], 1.0);
}
"""
