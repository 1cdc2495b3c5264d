// One control point for each piece, and for each cell of those that need more than the hardware's levels.
uniform int first_piece;
flat out ivec2 piece_and_cell;
void main() {
    piece_and_cell = ivec2(first_piece + gl_VertexID, gl_InstanceID);
    gl_Position = vec4(0.0);
}
