// Where the numbers are: a buffer of texels (docs/gpu.md). OpenGL 3.1 and later.
uniform samplerBuffer data;
vec4 texel(int i) { return texelFetch(data, i); }
