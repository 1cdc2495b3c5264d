// The figures: one for each row of what freiform knows about curves and surfaces.
#pragma once
#include "gallery/plot.hpp"

namespace freiform::cli::gallery {

struct Entry {
    std::string_view row;  // "R05"; also the name of its document
    std::string_view title;
    std::string_view words;  // two sentences
    std::string_view
        options;  // with which `freiform draw` shows the curves of the document; empty: it cannot
    Figure (*figure)(const Document&);
};
std::span<const Entry> entries();

// examples/gallery/ROW.json, as text. The table is made from these files when the program is built.
struct Source {
    std::string_view row, json;
};
std::span<const Source> sources();

// polynomials.cpp
Figure descriptions(const Document&);
Figure coefficients(const Document&);
Figure one_product(const Document&);
Figure hermite(const Document&);
Figure bezier_cubics(const Document&);
Figure bernstein(const Document&);
Figure changes(const Document&);
// joints.cpp
Figure joints(const Document&);
Figure curvature_joints(const Document&);
Figure interpolation(const Document&);
Figure a_frames(const Document&);
// splines.cpp
Figure uniform_splines(const Document&);
Figure nonuniform_splines(const Document&);
Figure conics(const Document&);
Figure de_casteljau(const Document&);
Figure subdivision(const Document&);
Figure properties(const Document&);
// steps.cpp
Figure forward_differences(const Document&);
Figure halving(const Document&);
Figure equal_distances(const Document&);
// tensor_products.cpp
Figure bicubic_patches(const Document&);
Figure tensor_products(const Document&);
Figure surface_steps(const Document&);
Figure interpolating_patches(const Document&);
// made_surfaces.cpp
Figure revolution(const Document&);
Figure curved_walls(const Document&);
Figure surface_joints(const Document&);
// trimming.cpp
Figure trimming(const Document&);
// surfaces.cpp
Figure rational_surfaces(const Document&);
Figure triangles(const Document&);
// illustration.cpp
Figure regions(const Document&);
Figure gradients(const Document&);
// letters.cpp
Figure letters(const Document&);
// bodies.cpp
Figure bodies(const Document&);
// motions.cpp
Figure motions(const Document&);

}  // namespace freiform::cli::gallery
