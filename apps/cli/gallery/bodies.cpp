// R34: plane profiles that become bodies, for the files of other programs.
#include "gallery/gallery.hpp"
#include "gallery/regions.hpp"
#include "gallery/space.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/make/frame_sweep.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/model/tessellate.hpp>

namespace freiform::cli::gallery {

Figure bodies(const Document& d) {
    const Path pot = path_in(d, {"pot"}), plate = path_in(d, {"plate", "plate left", "plate right"});
    Plot profile("profile", "a profile and its axis");
    filled(profile, pot, kBlue).lines({{{0, -0.2}}, {{0, 3.4}}}, dashed(kOrange, "axis"));
    Plot turned("turned", "turned by 270 degrees");
    const Eye eye = eye_at(-90, 118);  // y points up
    const auto turn = [&](double angle) {
        return sure(solid_of_revolution(loops_of(pot), {{{0, 0, 0}}, {{0, 1, 0}}}, angle));
    };
    DrawingOptions how;
    how.isolines = 3;
    together(turned, {{turn(0.75 * kTwoPi), {kBlue, 1.7, "", {}}}}, eye, how);
    Plot mesh("mesh", "triangles within a tolerance, for STL and glTF");
    triangles_of(mesh, sure(tessellate(turn(kTwoPi), {.tolerance = 0.05})).mesh, eye, {kBlue});
    Plot lifted("lifted", "a region with holes, lifted");
    how.isolines = 0;
    together(lifted, {{sure(prism(loops_of(plate), {{0, 0, 0.7}})), {kGreen, 1.7, "", {}}}}, eye_at(-60, 38),
             how);
    Plot carried("carried", "a section, carried along a rail");
    how.isolines = 9;
    together(carried,
             {{sure(sweep(curve_in(d, "section"), curve_in<Vec<3>>(d, "rail"), {1e-4, {}})).surface,
               {kOrange, 1.7, "", {}}},
              {curve_in<Vec<3>>(d, "rail"), {kInk, 1.4, "rail", {}}}},
             eye_at(-70, 18), how);
    return page("Bodies of plane profiles",
                {profile.panel, turned.panel, mesh.panel, lifted.panel, carried.panel}, 3, 1280, 860);
}

}  // namespace freiform::cli::gallery
