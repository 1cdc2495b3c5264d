// Where the numbers are: a texture of 4096 texels in a row (docs/gpu.md). OpenGL ES 3.0 and WebGL 2.
uniform highp sampler2D data;
vec4 texel(int i) { return texelFetch(data, ivec2(i & 4095, i >> 12), 0); }
