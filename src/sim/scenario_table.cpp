// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenario_table.hpp"

#include "scenario_entries.hpp"

namespace stylet {

namespace {

using Slot = ScenarioSlot;

TissueParameters& tissue(Scenario& s, const Slot& slot) {
  return s.tissue.try_emplace(slot.name, tissue_of(s, slot.name)).first->second;
}
const TissueParameters& tissue(const Scenario& s, const Slot& slot) { return s.tissue.at(slot.name); }

std::string& region(Scenario& s, const Slot& slot) { return s.patient.regions[slot.name]; }
const std::string& region(const Scenario& s, const Slot& slot) { return s.patient.regions.at(slot.name); }

InsertionPlan& plan(Scenario& s, const Slot& slot) {
  if (s.insertions.size() <= slot.index) s.insertions.resize(slot.index + 1);
  return s.insertions[slot.index];
}
const InsertionPlan& plan(const Scenario& s, const Slot& slot) { return s.insertions.at(slot.index); }

void describe_patient(ScenarioEntries& keys) {
  keys.text(
      "patient.source",
      "contours (RTSTRUCT, JSON), label mask or tetrahedral mesh; relative to the scenario file; \"phantom\" is the "
      "demo patient",
      [](auto& s, const Slot&) { return &s.patient.source; }, {.standard = "required", .example = "\"phantom\""});
  keys.number("patient.scale", "mm", 0, 1e6, "length of a mesh file's unit; 0 = as the file says, else mm",
              [](auto& s, const Slot&) { return &s.patient.scale; });
  keys.integer("patient.volume", 0, 1000000,
               "which volume of a mask file that holds several, counted from 1; 0 = the only one",
               [](auto& s, const Slot&) { return &s.patient.volume; });
  keys.texts("patient.skip", 0,
             "structures, by their names, or labels, by their names or numbers, to leave out, such as one that is "
             "drawn wrongly",
             [](auto& s, const Slot&) { return &s.patient.skip; }, {.standard = "[]", .example = "[\"Rectum\"]"});
  keys.text("patient.regions.<name>", "the region that a structure, by its name, or a label, by its number, stands for",
            [](auto& s, const Slot& slot) { return &region(s, slot); },
            {.standard = "by their names", .example = "\"peripheral_zone\""});
}

void describe_tissue(ScenarioEntries& keys) {
  keys.choice("tissue.preset",
              "where the defaults of all tissue come from: forces measured in patients, a dent under the tip that "
              "stiffens, and moduli in the middle of what is published (typical) or 1.6 times as stiff (firm) or as "
              "soft (soft); or linear elastic tissue (linear), as the methods of Goksel et al. 2005 have it, in which "
              "forces are small and the gland hardly moves",
              [](auto& s, const Slot&) { return &s.tissue_model.preset; });
  keys.choice(
      "tissue.element",
      "finite element; p1 = linear tetrahedra, stiffen as Poisson's ratio nears 0.5; nodal-pressure = linear "
      "tetrahedra with the change of volume averaged around nodes, do not; p2 = quadratic tetrahedra, nearly do "
      "not, eight times the nodes; auto = p1 with the coupling methods node-addition, "
      "node-repositioning and embedded and on meshes of more than 45,000 nodes, where the factor of nodal-pressure "
      "takes more than 6 GB, else nodal-pressure",
      [](auto& s, const Slot&) { return &s.tissue_model.element; });
  keys.number(
      "tissue.creep", "", 1, 100,
      "creep of all tissue: under a force that lasts it yields this many times as far as at once, so in the end "
      "it is as soft as tissue of young_kPa / creep; what is narrower than 10 mm around the needle does not "
      "creep; 1 = elastic",
      [](auto& s, const Slot&) { return &s.tissue_model.creep; },
      {.standard = "4, and 1 with preset = \"linear\"", .example = "4"});
  keys.number("tissue.creep_s", "s", 0.001, 1000,
              "time constant of that: after a time t under a constant force 1 - exp(-t/creep_s) of the creep has "
              "happened; a force under a constant displacement relaxes faster, with creep_s / creep",
              [](auto& s, const Slot&) { return &s.tissue_model.creep_s; });
  keys.number("tissue.<region>.young_kPa", "kPa", 0.1, 1e8,
              "Young's modulus; where tissue creeps the one that a fast load meets",
              [](auto& s, const Slot& t) { return &tissue(s, t).young_kPa; }, {.standard = "by region"});
  keys.number("tissue.<region>.poisson", "", 0, 0.4999,
              "Poisson ratio; linear tetrahedra (tissue.element) stiffen towards 0.5",
              [](auto& s, const Slot& t) { return &tissue(s, t).poisson; }, {.standard = "by region"});
  keys.number("tissue.<region>.cutting_N", "N", 0, 100, "axial force at which the tip cuts",
              [](auto& s, const Slot& t) { return &tissue(s, t).cutting_N; }, {.standard = "by region"});
  keys.number("tissue.<region>.puncture_N", "N", 0, 100,
              "force that breaks the surface around the region; 0 = no membrane",
              [](auto& s, const Slot& t) { return &tissue(s, t).puncture_N; }, {.standard = "by region"});
  keys.number(
      "tissue.<region>.stiffening", "", 0, 100,
      "how the dent under the tip stiffens: its force is k1 z + k2 z^2 at a depth z, and this is k2 over Young's "
      "modulus; 0 = linear. Only with coupling.method = \"near-field\" and coupling.solver = \"coupled\"",
      [](auto& s, const Slot& t) { return &tissue(s, t).stiffening; }, {.standard = "by region"});
  keys.number("tissue.<region>.friction_static_N_per_m", "N/m", 0, 1e4,
              "largest friction per inserted length while sticking",
              [](auto& s, const Slot& t) { return &tissue(s, t).friction_static_N_per_m; }, {.standard = "by region"});
  keys.number("tissue.<region>.friction_coulomb_N_per_m", "N/m", 0, 1e4,
              "friction per inserted length while sliding slowly",
              [](auto& s, const Slot& t) { return &tissue(s, t).friction_coulomb_N_per_m; }, {.standard = "by region"});
  keys.number("tissue.<region>.friction_viscous_Ns_per_m2", "N s/m²", 0, 1e6, "growth of sliding friction with speed",
              [](auto& s, const Slot& t) { return &tissue(s, t).friction_viscous_Ns_per_m2; });
  keys.number("tissue.<region>.friction_viscous_to_mm_per_s", "mm/s", 0.1, 10000,
              "speed up to which sliding friction grows; the viscous part has been measured on slow needles only",
              [](auto& s, const Slot& t) { return &tissue(s, t).friction_viscous_to_mm_per_s; });
}

void describe_supports(ScenarioEntries& keys) {
  keys.texts(
      "fixed.regions", 0, "regions whose nodes are all held", [](auto& s, const Slot&) { return &s.fixed.regions; },
      {.standard = "the bones: pubic_arch, femur_left, femur_right where present", .example = "[\"pubic_arch\"]"});
  keys.choice("fixed.outer",
              "outer faces held: sides = all but the perineal face and the surroundings of the entry; auto = none with "
              "a pubic arch, else sides",
              [](auto& s, const Slot&) { return &s.fixed.outer; });
  keys.vector<6>("fixed.box_mm", "mm", -1e5, 1e5,
                 "nodes inside this box are held as well: its low corner x, y, z and its high corner x, y, z, LPS",
                 [](auto& s, const Slot&) { return &s.fixed.box_mm; }, {.example = "[-40, -60, -30, 40, -30, 30]"});
}

void describe_anatomy(ScenarioEntries& keys) {
  keys.number("anatomy.periprostatic_fat_mm", "mm", 0, 40,
              "thickness of fat and venous plexus round gland and seminal vesicles, where the input has none; 0 = none",
              [](auto& s, const Slot&) { return &s.anatomy.periprostatic_fat_mm; });
  keys.number("anatomy.levator_mm", "mm", 0, 20,
              "thickness of the levator muscle round that fat and the rectum, below the gland's base; 0 = none",
              [](auto& s, const Slot&) { return &s.anatomy.levator_mm; });
  keys.number(
      "anatomy.ischiorectal_fat_mm", "mm", 0, 60,
      "width of the fat on either side of the rectum, from the layer under the skin to beside the apex; 0 = none",
      [](auto& s, const Slot&) { return &s.anatomy.ischiorectal_fat_mm; });
  keys.number("anatomy.subcutaneous_fat_mm", "mm", 0, 60,
              "thickness of the fat under the perineal skin, along the patient's axis; 0 = none",
              [](auto& s, const Slot&) { return &s.anatomy.subcutaneous_fat_mm; });
  keys.number("anatomy.rectal_wall_mm", "mm", 0, 20,
              "thickness of the rectum's wall, within it is the lumen; 0 = no lumen",
              [](auto& s, const Slot&) { return &s.anatomy.rectal_wall_mm; });
}

void describe_mesh(ScenarioEntries& keys) {
  keys.integer("mesh.nodes", 0, 1000000, "nodes of the mesh; 0 = 3,000 (standard) or 570 (paper)",
               [](auto& s, const Slot&) { return &s.mesh.nodes; });
  keys.choice("mesh.preset",
              "what is meshed: standard = all anatomy there is; paper = the target and its surroundings only, as "
              "Goksel et al. 2005",
              [](auto& s, const Slot&) { return &s.mesh.preset; });
  keys.number("mesh.cull_mm", "mm", 0, 5, "contour points nearer than this to the contour without them are dropped",
              [](auto& s, const Slot&) { return &s.mesh.cull_mm; });
  keys.boolean("mesh.stiff_band", "without a pubic arch: add the band that holds the gland's anterior-inferior end",
               [](auto& s, const Slot&) { return &s.mesh.stiff_band; });
}

void describe_needle(ScenarioEntries& keys) {
  keys.choice(
      "needle.model",
      "needle model; beam = geometrically exact rod, springs = rigid rods joined by angular springs, tet = bar of "
      "tetrahedra as Goksel et al. 2005",
      [](auto& s, const Slot&) { return &s.needle.model; });
  keys.number("needle.length_mm", "mm", 20, 1000, "length from base to tip",
              [](auto& s, const Slot&) { return &s.needle.length_mm; });
  keys.number("needle.diameter_mm", "mm", 0.2, 5, "outer diameter; 18 gauge is 1.27",
              [](auto& s, const Slot&) { return &s.needle.diameter_mm; });
  keys.number("needle.lumen_diameter_mm", "mm", 0, 5, "inner diameter of the tube; 0 = solid",
              [](auto& s, const Slot&) { return &s.needle.lumen_diameter_mm; },
              {.standard = "0.787 of the outer diameter, 1.0 for 18 gauge", .example = "1"});
  keys.number("needle.young_GPa", "GPa", 0.5, 230, "Young's modulus of the tube; steel has 200",
              [](auto& s, const Slot&) { return &s.needle.young_GPa; });
  keys.choice("needle.stylet",
              "whether the stylet is in the tube: it slides freely, so its bending stiffness adds to the tube's",
              [](auto& s, const Slot&) { return &s.needle.stylet; });
  keys.number("needle.stylet_diameter_mm", "mm", 0.05, 5, "diameter of the stylet",
              [](auto& s, const Slot&) { return &s.needle.stylet_diameter_mm; },
              {.standard = "0.9 of the lumen", .example = "0.9"});
  keys.number("needle.stylet_young_GPa", "GPa", 0.5, 230, "Young's modulus of the stylet",
              [](auto& s, const Slot&) { return &s.needle.stylet_young_GPa; });
  keys.number("needle.bending_stiffness_Nmm2", "N mm²", 1, 1e7,
              "bending stiffness E I as measured, instead of the section's",
              [](auto& s, const Slot&) { return &s.needle.bending_stiffness_Nmm2; },
              {.standard = "from the section, 15,722 for the default tube", .example = "15722"});
  keys.number("needle.torsion_stiffness_Nmm2", "N mm²", 1, 1e7, "torsion stiffness G J, instead of the section's",
              [](auto& s, const Slot&) { return &s.needle.torsion_stiffness_Nmm2; },
              {.standard = "from the section, 12,094 for the default tube", .example = "12094"});
  keys.number("needle.bevel_deg", "degree", 0, 60,
              "angle between the face of the tip's bevel and the axis, 10 … 30 for bevelled needles; 0 = symmetric tip",
              [](auto& s, const Slot&) { return &s.needle.bevel_deg; });
  keys.choice(
      "needle.bevel_law",
      "what a bevel does: the cut runs beside the axis on the sharp side; or the tissue pushes the tip sideways",
      [](auto& s, const Slot&) { return &s.needle.bevel_law; });
  keys.number("needle.bevel_force_ratio", "", 0, 1, "bevel_law force: lateral over axial force of the tip",
              [](auto& s, const Slot&) { return &s.needle.bevel_force_ratio; });
  keys.number("needle.bow_mm", "mm", 0, 100,
              "how far the tip of the unloaded needle lies beside its axis (it is bent to a circle); up to a tenth of "
              "the length",
              [](auto& s, const Slot&) { return &s.needle.bow_mm; });
  keys.number("needle.bow_deg", "degree", -360, 360,
              "side to which it is bent, about the axis from the base's x to its y; turns with the needle's roll",
              [](auto& s, const Slot&) { return &s.needle.bow_deg; });
  keys.integer("needle.elements", 0, 200,
               "number of elements of the needle, at least 4; 0 = 24 (beam, springs) or 60 (tet)",
               [](auto& s, const Slot&) { return &s.needle.elements; });
}

void describe_coupling(ScenarioEntries& keys) {
  keys.choice("coupling.method",
              "how needle and tissue are coupled: forces are interpolated and the needle's near field, which no mesh "
              "represents, "
              "is put right; a tissue node is added where the needle needs one; the nearest one is moved there (engine "
              "woodbury "
              "or bcs); forces are interpolated",
              [](auto& s, const Slot&) { return &s.coupling.method; });
  keys.choice("coupling.rule",
              "where node-addition adds them: inside elements at the contact spacing, or on every face crossed",
              [](auto& s, const Slot&) { return &s.coupling.rule; });
  keys.choice("coupling.solver",
              "needle and tissue in one solve, or in turn as in Goksel et al. 2005 (slower, same answer)",
              [](auto& s, const Slot&) { return &s.coupling.solver; });
  keys.choice(
      "coupling.engine",
      "what is kept of the inverse stiffness: what the needle touches, or all of it, changed in place by the "
      "matrix inversion lemma or by boundary condition switches (Goksel et al. 2005; up to some thousand nodes)",
      [](auto& s, const Slot&) { return &s.coupling.engine; });
  keys.number("coupling.damping", "", 0.6, 2,
              "staggered solver: springs that damp the needle, over the tissue's own stiffness around each contact",
              [](auto& s, const Slot&) { return &s.coupling.damping; });
  keys.choice(
      "coupling.projection",
      "staggered solver: contact forces act on the needle where the contacts are, or at the nearest node of the "
      "needle as in Goksel et al. 2005",
      [](auto& s, const Slot&) { return &s.coupling.projection; });
  keys.number("coupling.spacing_mm", "mm", 1, 50, "distance between contacts; at least the needle's diameter",
              [](auto& s, const Slot&) { return &s.coupling.spacing_mm; });
  keys.number("coupling.tip_viscosity_Ns_per_m", "N s/m", 0.01, 1000,
              "growth of the cutting force with the speed of cutting",
              [](auto& s, const Slot&) { return &s.coupling.tip_viscosity_Ns_per_m; });
  keys.number("coupling.bone_damping_ms", "ms", 0, 100,
              "time constant of the needle's internal damping while its tip stands on bone",
              [](auto& s, const Slot&) { return &s.coupling.bone_damping_ms; });
  keys.number("coupling.grazing_deg", "degree", 30, 89,
              "a needle flatter to the skin than this (angle to the normal) slides off",
              [](auto& s, const Slot&) { return &s.coupling.grazing_deg; });
  keys.number("coupling.corridor_mm", "mm", 1, 50,
              "radius around the planned path in which compliance is computed before the start",
              [](auto& s, const Slot&) { return &s.coupling.corridor_mm; });
  keys.integer(
      "coupling.corridor_nodes", 1, 20000,
      "most nodes of the mesh in it, the nearest; n of them take 36 n² bytes. Elsewhere compliance is computed "
      "when the needle comes",
      [](auto& s, const Slot&) { return &s.coupling.corridor_nodes; });
  keys.integer("coupling.spare_nodes", 50, 20000,
               "most nodes elsewhere whose compliance is kept; those far from the tip, which no contact needs, are "
               "forgotten first",
               [](auto& s, const Slot&) { return &s.coupling.spare_nodes; });
  keys.integer("coupling.contacts", 8, 400, "largest number of contacts",
               [](auto& s, const Slot&) { return &s.coupling.contacts; });
  keys.number("coupling.tolerance", "", 1e-12, 1e-4,
              "coupled solver: error that a balance of needle and tissue may have, as a force over the largest one or "
              "1 N; results do not hang on it",
              [](auto& s, const Slot&) { return &s.coupling.tolerance; });
}

void describe_template(ScenarioEntries& keys) {
  keys.number("template.pitch_mm", "mm", 1, 20, "distance of neighbouring holes",
              [](auto& s, const Slot&) { return &s.grid.pitch_mm; });
  keys.vector<2>("template.centre_mm", "mm", -1e4, 1e4, "LPS x and y of the middle of the grid, hole D4",
                 [](auto& s, const Slot&) { return &s.grid.centre_mm; },
                 {.standard = "the target's centroid", .example = "[0, 0]"});
  keys.texts("template.columns", 1, "column names from the patient's right to the left",
             [](auto& s, const Slot&) { return &s.grid.columns; });
  keys.texts("template.rows", 1, "row names from posterior to anterior",
             [](auto& s, const Slot&) { return &s.grid.rows; });
  keys.boolean("template.guide",
               "the hole holds the shaft sideways, whichever way the needle's line is given; it slides through freely",
               [](auto& s, const Slot&) { return &s.grid.guide; });
  keys.number("template.clearance_mm", "mm", 0, 2, "radius of the hole less radius of the needle",
              [](auto& s, const Slot&) { return &s.grid.clearance_mm; });
  keys.number("template.distance_mm", "mm", 0, 300,
              "distance of the template from the skin along the needle; the base stops before it",
              [](auto& s, const Slot&) { return &s.grid.distance_mm; });
}

void describe_insertion(ScenarioEntries& keys) {
  keys.text("insertion[].hole", "template hole; the needle goes along +z (superior)",
            [](auto& s, const Slot& i) { return &plan(s, i).hole; }, {.example = "\"D4\""});
  keys.vector<3>("insertion[].entry_mm", "mm", -1e4, 1e4, "a point on the needle's line, LPS, instead of a hole",
                 [](auto& s, const Slot& i) { return &plan(s, i).entry_mm; }, {.example = "[10, 5, -80]"});
  keys.vector<3>("insertion[].direction", "", -1e4, 1e4, "direction of the insertion, LPS, a vector of any length",
                 [](auto& s, const Slot& i) { return &plan(s, i).direction; },
                 {.standard = "[0, 0, 1]", .example = "[0, 0, 1]"});
  keys.vector<3>("insertion[].target_mm", "mm", -1e4, 1e4, "a point to aim at, LPS, instead of a direction",
                 [](auto& s, const Slot& i) { return &plan(s, i).target_mm; }, {.example = "[10, 5, 0]"});
  keys.number(
      "insertion[].roll_deg", "degree", -360, 360,
      "turn of the needle about its axis; at 0 the bevel's sharp side is to the patient's left, at 90 posterior "
      "for a needle going superior",
      [](auto& s, const Slot& i) { return &plan(s, i).roll_deg; });
  keys.number("insertion[].approach_mm", "mm", 0.1, 200, "free travel before the skin",
              [](auto& s, const Slot& i) { return &plan(s, i).approach_mm; });
  keys.number("insertion[].depth_mm", "mm", 0, 1000,
              "base travel beyond skin contact; 0 = to the far end of the target",
              [](auto& s, const Slot& i) { return &plan(s, i).depth_mm; });
  keys.number("insertion[].speed_mm_per_s", "mm/s", 0.01, 1000, "speed of the base going in",
              [](auto& s, const Slot& i) { return &plan(s, i).speed_mm_per_s; });
  keys.number("insertion[].dwell_s", "s", 0, 3600, "pause at full depth",
              [](auto& s, const Slot& i) { return &plan(s, i).dwell_s; });
  keys.number("insertion[].retract_speed_mm_per_s", "mm/s", 0.01, 1000, "speed of the base going out",
              [](auto& s, const Slot& i) { return &plan(s, i).retract_speed_mm_per_s; });
  keys.boolean("insertion[].retract", "pull the needle out after the pause",
               [](auto& s, const Slot& i) { return &plan(s, i).retract; });
  keys.text("insertion[].motion",
            "CSV of a recorded base motion (time_s, x_mm, y_mm, z_mm, qw, qx, qy, qz) instead of all the above; "
            "relative to the scenario file",
            [](auto& s, const Slot& i) { return &plan(s, i).motion; }, {.example = "\"base_motion.csv\""});
}

void describe_run_and_output(ScenarioEntries& keys) {
  keys.number("run.dt_ms", "ms", 0.01, 20, "time step", [](auto& s, const Slot&) { return &s.run.dt_ms; });
  keys.number("output.frames_per_s", "1/s", 0, 1000,
              "frames of simulated time kept for pictures and ParaView; 0 = the events only",
              [](auto& s, const Slot&) { return &s.output.frames_per_s; });
  keys.integer("output.max_frames", 2, 5000, "at most this many frames",
               [](auto& s, const Slot&) { return &s.output.max_frames; });
  keys.boolean("output.pictures", "still pictures in the report",
               [](auto& s, const Slot&) { return &s.output.pictures; });
}

}  // namespace

const std::vector<ScenarioEntry>& scenario_table() {
  static const std::vector<ScenarioEntry> table = [] {
    ScenarioEntries keys;
    keys.text("name", "what the report calls this run", [](auto& s, const Slot&) { return &s.name; });
    describe_patient(keys);
    describe_tissue(keys);
    describe_supports(keys);
    describe_anatomy(keys);
    describe_mesh(keys);
    describe_needle(keys);
    describe_coupling(keys);
    describe_template(keys);
    describe_insertion(keys);
    describe_run_and_output(keys);
    return std::move(keys).take();
  }();
  return table;
}

}  // namespace stylet
