in vec3 place, direction, albedo;
flat in float outward;
out vec4 colour;
void main() {
    vec3 paint = decoded(albedo);
    colour = vec4(shaded(place, direction, view_from(place), outward, paint, vec4(paint, 1.0)), 1.0);
}
