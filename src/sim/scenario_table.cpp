// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenario_table.hpp"

#include "imaging_entries.hpp"
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

/// An entry of a list, which grows to have it.
template <class T>
T& entry(std::vector<T>& list, const Slot& slot) {
  if (list.size() <= slot.index) list.resize(slot.index + 1);
  return list[slot.index];
}
template <class T>
const T& entry(const std::vector<T>& list, const Slot& slot) {
  return list.at(slot.index);
}

InsertionPlan& plan(Scenario& s, const Slot& slot) { return entry(s.insertions, slot); }
const InsertionPlan& plan(const Scenario& s, const Slot& slot) { return entry(s.insertions, slot); }

void describe_patient(ScenarioEntries& keys) {
  keys.text("patient.source",
            "file with contours (RTSTRUCT, JSON), a label mask or a tetrahedral mesh; a relative path starts at the "
            "scenario file's folder; \"phantom\" is the demo patient",
            [](auto& s, const Slot&) { return &s.patient.source; }, {.standard = "required", .example = "\"phantom\""});
  keys.number("patient.scale", "mm", 0, 1e6,
              "length of the unit of a mesh file; 0 = as the file states, or 1 mm if it does not",
              [](auto& s, const Slot&) { return &s.patient.scale; });
  keys.integer("patient.volume", 0, 1000000,
               "number of the volume in a mask file with several volumes, counted from 1; 0 = the only one",
               [](auto& s, const Slot&) { return &s.patient.volume; });
  keys.text(
      "patient.regions_from",
      "array of a mesh file that is its regions: name of a cell array (VTU, VTK) or of $ElementData (gmsh), or "
      "\"attribute N\" (TetGen); without it the format's own regions, or the only array of whole numbers that can be "
      "them",
      [](auto& s, const Slot&) { return &s.patient.regions_from; }, {.example = "\"tissue\""});
  keys.texts(
      "patient.skip", 0,
      "structures (names) or labels (names or numbers) to leave out, for example a structure that is drawn wrongly",
      [](auto& s, const Slot&) { return &s.patient.skip; }, {.standard = "[]", .example = "[\"Rectum\"]"});
  keys.text("patient.regions.<name>", "region for a structure, given by its name, or for a label, given by its number",
            [](auto& s, const Slot& slot) { return &region(s, slot); },
            {.standard = "by their names", .example = "\"peripheral_zone\""});
}

void describe_tissue(ScenarioEntries& keys) {
  keys.choice("tissue.preset",
              "source of the default values of all tissue; typical = forces measured in patients, a dent under the tip "
              "that stiffens, and moduli in the middle of the published range; firm, soft = the same with the moduli "
              "multiplied or divided by 1.6; linear = linear elastic tissue as in the methods of Goksel et al. 2005, "
              "in which forces are small and the gland hardly moves",
              [](auto& s, const Slot&) { return &s.tissue_model.preset; });
  keys.choice(
      "tissue.element",
      "finite element; p1 = linear tetrahedra, which become too stiff as Poisson's ratio approaches 0.5; "
      "nodal-pressure = linear tetrahedra with the change of volume averaged around nodes, which do not; p2 = "
      "quadratic tetrahedra, which hardly do, but have eight times as many nodes; auto = p1 with the coupling methods "
      "node-addition, node-repositioning and embedded, with the engines woodbury and bcs, and on meshes of more than "
      "45,000 nodes, where the factor of nodal-pressure takes more than 6 GB, otherwise nodal-pressure",
      [](auto& s, const Slot&) { return &s.tissue_model.element; });
  keys.number("tissue.creep", "", 1, 100,
              "creep of all tissue: ratio of the final to the immediate displacement under a constant force, so that "
              "in the end the tissue is as soft as tissue with young_kPa / creep; the part of the displacement that is "
              "narrower than 10 mm around the needle does not creep; 1 = elastic",
              [](auto& s, const Slot&) { return &s.tissue_model.creep; },
              {.standard = "4, and 1 with preset = \"linear\"", .example = "4"});
  keys.number(
      "tissue.creep_s", "s", 0.001, 1000,
      "time constant of the creep: after a time t under a constant force the share 1 - exp(-t/creep_s) of the creep "
      "has happened; under a constant displacement the force relaxes faster, with the time constant creep_s / creep",
      [](auto& s, const Slot&) { return &s.tissue_model.creep_s; });
  keys.number("tissue.<region>.young_kPa", "kPa", 0.1, 1e8,
              "Young's modulus; if the tissue creeps, the instantaneous modulus, which a fast load meets",
              [](auto& s, const Slot& t) { return &tissue(s, t).young_kPa; }, {.standard = "by region"});
  keys.number("tissue.<region>.poisson", "", 0, 0.4999,
              "Poisson ratio; linear tetrahedra (tissue.element) become too stiff as it approaches 0.5",
              [](auto& s, const Slot& t) { return &tissue(s, t).poisson; }, {.standard = "by region"});
  keys.number("tissue.<region>.cutting_N", "N", 0, 100, "axial force at which the tip cuts",
              [](auto& s, const Slot& t) { return &tissue(s, t).cutting_N; }, {.standard = "by region"});
  keys.number("tissue.<region>.puncture_N", "N", 0, 100,
              "force that breaks the surface around the region; 0 = no membrane",
              [](auto& s, const Slot& t) { return &tissue(s, t).puncture_N; }, {.standard = "by region"});
  keys.number(
      "tissue.<region>.stiffening", "", 0, 100,
      "stiffening of the dent under the tip: the force at a depth z is k1 z + k2 z^2, and this value is k2 divided by "
      "Young's modulus; 0 = linear. Only with coupling.method = \"near-field\" and coupling.solver = \"coupled\"",
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

void describe_echo(ScenarioEntries& keys) {
  keys.number("tissue.<region>.echo_dB", "dB", -100, 40,
              "strength of the speckle in ultrasound, relative to the gland's peripheral zone",
              [](auto& s, const Slot& t) { return &tissue(s, t).echo.echo_dB; }, {.standard = "by region"});
  keys.number("tissue.<region>.attenuation_dB_per_cm_MHz", "dB/cm/MHz", 0, 50, "attenuation of ultrasound, one way",
              [](auto& s, const Slot& t) { return &tissue(s, t).echo.attenuation_dB_per_cm_MHz; },
              {.standard = "by region"});
}

void describe_supports(ScenarioEntries& keys) {
  keys.texts("fixed.regions", 0, "regions whose nodes are all held",
             [](auto& s, const Slot&) { return &s.fixed.regions; },
             {.standard = "the bones: pubic_arch, femur_left, femur_right if present", .example = "[\"pubic_arch\"]"});
  keys.choice("fixed.outer",
              "outer faces that are held; sides = all except the perineal face and the surroundings of the entry; auto "
              "= none with a pubic arch, otherwise sides",
              [](auto& s, const Slot&) { return &s.fixed.outer; });
  keys.vector<6>("fixed.box_mm", "mm", -1e5, 1e5,
                 "nodes inside this box are held as well: low corner x, y, z, then high corner x, y, z, LPS",
                 [](auto& s, const Slot&) { return &s.fixed.box_mm; }, {.example = "[-40, -60, -30, 40, -30, 30]"});
}

void describe_anatomy(ScenarioEntries& keys) {
  keys.number(
      "anatomy.periprostatic_fat_mm", "mm", 0, 40,
      "thickness of the fat and venous plexus around gland and seminal vesicles, added if the input has none; 0 = none",
      [](auto& s, const Slot&) { return &s.anatomy.periprostatic_fat_mm; });
  keys.number(
      "anatomy.levator_mm", "mm", 0, 20,
      "thickness of the levator muscle around the periprostatic fat and the rectum, below the gland's base; 0 = none",
      [](auto& s, const Slot&) { return &s.anatomy.levator_mm; });
  keys.number(
      "anatomy.ischiorectal_fat_mm", "mm", 0, 60,
      "width of the fat on either side of the rectum, from the layer under the skin to 12 mm above the apex; 0 = none",
      [](auto& s, const Slot&) { return &s.anatomy.ischiorectal_fat_mm; });
  keys.number("anatomy.subcutaneous_fat_mm", "mm", 0, 60,
              "thickness of the fat under the perineal skin, along the patient's axis; 0 = none",
              [](auto& s, const Slot&) { return &s.anatomy.subcutaneous_fat_mm; });
  keys.number("anatomy.rectal_wall_mm", "mm", 0, 20,
              "thickness of the rectum's wall, which encloses the lumen; 0 = no lumen",
              [](auto& s, const Slot&) { return &s.anatomy.rectal_wall_mm; });
}

void describe_mesh(ScenarioEntries& keys) {
  keys.integer("mesh.nodes", 0, 1000000, "number of nodes of the mesh; 0 = 3,000 (standard) or 570 (paper)",
               [](auto& s, const Slot&) { return &s.mesh.nodes; });
  keys.choice("mesh.preset",
              "content of the mesh; standard = all available anatomy; paper = only the target and its surroundings, as "
              "in Goksel et al. 2005",
              [](auto& s, const Slot&) { return &s.mesh.preset; });
  keys.number("mesh.cull_mm", "mm", 0, 5,
              "contour points are dropped if their distance from the contour without them is smaller than this",
              [](auto& s, const Slot&) { return &s.mesh.cull_mm; });
  keys.boolean("mesh.stiff_band",
               "without a pubic arch: add the stiff band that holds the gland's anterior-inferior end",
               [](auto& s, const Slot&) { return &s.mesh.stiff_band; });
}

void describe_needle(ScenarioEntries& keys) {
  keys.choice("needle.model",
              "needle model; beam = geometrically exact rod, springs = rigid rods joined by angular springs, tet = bar "
              "of tetrahedra as in Goksel et al. 2005",
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
              "whether the stylet is in the tube; it slides freely, so its bending stiffness is added to the tube's",
              [](auto& s, const Slot&) { return &s.needle.stylet; });
  keys.number("needle.stylet_diameter_mm", "mm", 0.05, 5, "diameter of the stylet",
              [](auto& s, const Slot&) { return &s.needle.stylet_diameter_mm; },
              {.standard = "0.9 of the lumen", .example = "0.9"});
  keys.number("needle.stylet_young_GPa", "GPa", 0.5, 230, "Young's modulus of the stylet",
              [](auto& s, const Slot&) { return &s.needle.stylet_young_GPa; });
  keys.number("needle.bending_stiffness_Nmm2", "N mm²", 1, 1e7,
              "measured bending stiffness E I, which replaces the one computed from the section",
              [](auto& s, const Slot&) { return &s.needle.bending_stiffness_Nmm2; },
              {.standard = "from the section, 15,722 for the default tube", .example = "15722"});
  keys.number("needle.torsion_stiffness_Nmm2", "N mm²", 1, 1e7,
              "torsion stiffness G J, which replaces the one computed from the section",
              [](auto& s, const Slot&) { return &s.needle.torsion_stiffness_Nmm2; },
              {.standard = "from the section, 12,094 for the default tube", .example = "12094"});
  keys.number("needle.bevel_deg", "degree", 0, 60,
              "angle between the face of the tip's bevel and the axis, 10 … 30 for bevelled needles; 0 = symmetric tip",
              [](auto& s, const Slot&) { return &s.needle.bevel_deg; });
  keys.choice("needle.bevel_law",
              "effect of a bevel; offset = the cut runs beside the axis, on the sharp side; force = the tissue pushes "
              "the tip sideways",
              [](auto& s, const Slot&) { return &s.needle.bevel_law; });
  keys.number("needle.bevel_force_ratio", "", 0, 1,
              "with bevel_law = \"force\": ratio of the lateral to the axial force of the tip",
              [](auto& s, const Slot&) { return &s.needle.bevel_force_ratio; });
  keys.number("needle.bow_mm", "mm", 0, 100,
              "distance of the unloaded needle's tip from its axis (the needle is bent to a circle); up to a tenth of "
              "the length",
              [](auto& s, const Slot&) { return &s.needle.bow_mm; });
  keys.number("needle.bow_deg", "degree", -360, 360,
              "direction in which the needle is bent, as an angle about the axis from the base's x axis to its y axis; "
              "it turns with the needle's roll",
              [](auto& s, const Slot&) { return &s.needle.bow_deg; });
  keys.integer("needle.elements", 0, 200,
               "number of elements of the needle, at least 4; 0 = 24 (beam, springs) or 60 (tet)",
               [](auto& s, const Slot&) { return &s.needle.elements; });
}

void describe_coupling(ScenarioEntries& keys) {
  keys.choice("coupling.method",
              "coupling of needle and tissue; near-field = forces are interpolated, and the needle's near field, which "
              "no mesh can represent, is corrected; node-addition = a tissue node is added where the needle needs one; "
              "node-repositioning = the nearest node is moved there (engine woodbury or bcs); embedded = forces are "
              "interpolated",
              [](auto& s, const Slot&) { return &s.coupling.method; });
  keys.choice("coupling.rule",
              "where node-addition adds nodes; interior = inside elements at the contact spacing; paper = on every "
              "face that the needle crosses",
              [](auto& s, const Slot&) { return &s.coupling.rule; });
  keys.choice("coupling.solver",
              "solution method; coupled = needle and tissue are solved together; staggered = alternately, as in Goksel "
              "et al. 2005 (slower, same result)",
              [](auto& s, const Slot&) { return &s.coupling.solver; });
  keys.choice("coupling.engine",
              "stored part of the inverse stiffness; condensed = only the part that the needle touches; woodbury, bcs "
              "= all of it, updated in place by the matrix inversion lemma or by boundary condition switches (Goksel "
              "et al. 2005; up to some thousand nodes)",
              [](auto& s, const Slot&) { return &s.coupling.engine; });
  keys.number("coupling.damping", "", 0.6, 2,
              "staggered solver: stiffness of the springs that damp the needle, divided by the tissue's own stiffness "
              "around each contact",
              [](auto& s, const Slot&) { return &s.coupling.damping; });
  keys.choice("coupling.projection",
              "staggered solver: where contact forces act on the needle; exact = at the contacts; nearest-node = at "
              "the nearest node of the needle, as in Goksel et al. 2005",
              [](auto& s, const Slot&) { return &s.coupling.projection; });
  keys.number("coupling.spacing_mm", "mm", 1, 50, "distance between contacts; at least the needle's diameter",
              [](auto& s, const Slot&) { return &s.coupling.spacing_mm; });
  keys.number("coupling.tip_viscosity_Ns_per_m", "N s/m", 0.01, 1000,
              "growth of the cutting force with the speed of cutting",
              [](auto& s, const Slot&) { return &s.coupling.tip_viscosity_Ns_per_m; });
  keys.number("coupling.bone_damping_ms", "ms", 0, 100,
              "time constant of the needle's internal damping while its tip is on bone",
              [](auto& s, const Slot&) { return &s.coupling.bone_damping_ms; });
  keys.number("coupling.grazing_deg", "degree", 30, 89,
              "a needle whose angle to the skin's normal is larger than this slides off",
              [](auto& s, const Slot&) { return &s.coupling.grazing_deg; });
  keys.number("coupling.corridor_mm", "mm", 1, 50,
              "radius around the planned path within which compliance is computed before the start",
              [](auto& s, const Slot&) { return &s.coupling.corridor_mm; });
  keys.integer("coupling.corridor_nodes", 1, 20000,
               "largest number of nodes of the mesh in that corridor, of which the nearest are chosen; n nodes take 36 "
               "n² bytes. Elsewhere compliance is computed when the needle comes near",
               [](auto& s, const Slot&) { return &s.coupling.corridor_nodes; });
  keys.integer("coupling.spare_nodes", 50, 20000,
               "largest number of nodes outside of the corridor whose compliance is kept; nodes that are far from the "
               "tip and needed by no contact are dropped first",
               [](auto& s, const Slot&) { return &s.coupling.spare_nodes; });
  keys.integer("coupling.contacts", 8, 400, "largest number of contacts",
               [](auto& s, const Slot&) { return &s.coupling.contacts; });
  keys.number("coupling.tolerance", "", 1e-12, 1e-4,
              "coupled solver: allowed error of the balance of needle and tissue, as a force divided by the largest "
              "force or 1 N; results do not depend on it",
              [](auto& s, const Slot&) { return &s.coupling.tolerance; });
}

void describe_template(ScenarioEntries& keys) {
  keys.number("template.pitch_mm", "mm", 1, 20, "distance between neighbouring holes",
              [](auto& s, const Slot&) { return &s.grid.pitch_mm; });
  keys.vector<2>("template.centre_mm", "mm", -1e4, 1e4, "LPS x and y of the centre of the grid, hole D4",
                 [](auto& s, const Slot&) { return &s.grid.centre_mm; },
                 {.standard = "the target's centroid", .example = "[0, 0]"});
  keys.texts("template.columns", 1, "column names from the patient's right to the left",
             [](auto& s, const Slot&) { return &s.grid.columns; });
  keys.texts("template.rows", 1, "row names from posterior to anterior",
             [](auto& s, const Slot&) { return &s.grid.rows; });
  keys.boolean("template.guide",
               "whether the hole holds the shaft sideways, however the needle's line is given; the shaft slides "
               "through it without friction",
               [](auto& s, const Slot&) { return &s.grid.guide; });
  keys.number("template.clearance_mm", "mm", 0, 2, "radius of the hole minus radius of the needle",
              [](auto& s, const Slot&) { return &s.grid.clearance_mm; });
  keys.number("template.distance_mm", "mm", 0, 300,
              "distance between template and skin along the needle; the base stops before the template",
              [](auto& s, const Slot&) { return &s.grid.distance_mm; });
}

void describe_implant(ScenarioEntries& keys) {
  keys.text(
      "plan.file",
      "plan of seeds, or of dwell positions (HDR), for stylet implant: DICOM RTPLAN, JSON or CSV; a relative path "
      "starts at the scenario file's folder",
      [](auto& s, const Slot&) { return &s.plan.file; }, {.example = "\"demo_plan.csv\""});
  keys.text("plan.source",
            "source model of the seeds (stylet info sources), or a file with one; none = the plan names it",
            [](auto& s, const Slot&) { return &s.plan.source; }, {.example = "\"i125_6711\""});
  keys.text("plan.goals",
            "table of goals for the dose (CSV); none = those of [[plan.goal]], or else goals for permanent implants of "
            "the prostate, and no goals for temporary ones",
            [](auto& s, const Slot&) { return &s.plan.goals; }, {.example = "\"goals.csv\""});
  keys.text("plan.label", "label of a plan with [[plan.needle]]", [](auto& s, const Slot&) { return &s.plan.label; },
            {.example = "\"from my notes\""});
  keys.number("plan.strength_U", "U", 0, 1000,
              "air-kerma strength of a seed of [[plan.needle]]; 0 = each needle has its own",
              [](auto& s, const Slot&) { return &s.plan.strength_U; });
  keys.number("plan.prescription_Gy", "Gy", 0, 1000,
              "prescribed dose of a plan with [[plan.needle]]; 0 = none, and no goals in per cent",
              [](auto& s, const Slot&) { return &s.plan.prescription_Gy; });
  keys.number("plan.base_mm", "mm", -1e4, 1e4,
              "LPS z of the base plane, from which the retraction planes of [[plan.needle]] are counted to inferior",
              [](auto& s, const Slot&) { return &s.plan.base_mm; }, {.example = "40"});
  keys.number("plan.seed_length_mm", "mm", 0.1, 20, "length of a seed in a train of [[plan.needle]]",
              [](auto& s, const Slot&) { return &s.plan.seed_length_mm; });
  keys.number("plan.spacer_length_mm", "mm", 0.1, 20, "length of a spacer in a train of [[plan.needle]]",
              [](auto& s, const Slot&) { return &s.plan.spacer_length_mm; });
  keys.text("plan.needle[].hole", "template hole of the needle; needs template.centre_mm",
            [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).hole; }, {.example = "\"D4\""});
  keys.vector<2>("plan.needle[].at_mm", "mm", -1e4, 1e4, "LPS x and y of the needle's line, instead of a hole",
                 [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).at_mm; }, {.example = "[10, 5]"});
  keys.number(
      "plan.needle[].retraction_mm", "mm", -500, 500,
      "distance from the base plane to the retraction plane, to inferior; the centre of a train's first seed is "
      "on this plane",
      [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).retraction_mm; });
  keys.text("plan.needle[].train",
            "seeds (S) and numbers of spacers from the needle's tip on, separated by -; the seeds of \"S-1-S\" are one "
            "seed and one spacer apart",
            [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).train; }, {.example = "\"S-1-S-2-S\""});
  keys.ascending("plan.needle[].seeds_mm", "mm", 0, 500,
                 "distances of the seeds' centres from the retraction plane, to inferior, instead of a train",
                 [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).seeds_mm; },
                 {.standard = "[]", .example = "[0, 10, 20]"});
  keys.number("plan.needle[].strength_U", "U", 1e-6, 1000, "air-kerma strength of this needle's seeds",
              [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).strength_U; },
              {.standard = "plan.strength_U", .example = "0.5"});
  keys.boolean("plan.needle[].stranded", "whether the seeds of this needle are a strand",
               [](auto& s, const Slot& i) { return &entry(s.plan.needles, i).stranded; },
               {.standard = "seed.stranded", .example = "true"});
  keys.text("plan.goal[].structure", "structure of the goal: prostate (the target), urethra, rectum, bladder, …",
            [](auto& s, const Slot& i) { return &entry(s.plan.goal_table, i).structure; },
            {.standard = "required", .example = "\"prostate\""});
  keys.text("plan.goal[].metric", "figure of its dose–volume histogram, such as D90_percent, D2cc_Gy or V150_cc",
            [](auto& s, const Slot& i) { return &entry(s.plan.goal_table, i).metric; },
            {.standard = "required", .example = "\"D90_percent\""});
  keys.text("plan.goal[].bound", "bound of the figure, with > or <",
            [](auto& s, const Slot& i) { return &entry(s.plan.goal_table, i).bound; },
            {.standard = "required", .example = "\">=100\""});
  keys.text("plan.goal[].citation", "publication or protocol of the goal",
            [](auto& s, const Slot& i) { return &entry(s.plan.goal_table, i).citation; },
            {.example = "\"our protocol\""});
  keys.choice(
      "procedure.technique",
      "how seeds leave a needle; preloaded = the cannula is drawn back over a stylet that stays, and each seed "
      "rests in space until the cannula has passed it; pushed = the needle stops where a seed is wanted, and the "
      "seed is pushed out in front of its tip",
      [](auto& s, const Slot&) { return &s.procedure.technique; });
  keys.choice("procedure.order", "order in which the needles go in",
              [](auto& s, const Slot&) { return &s.procedure.order; });
  keys.choice("procedure.together",
              "needles of the plan that are in the tissue at the same time; row = all needles at one height of the "
              "template go in before the first of them drops its seeds; all = all needles of the plan; the catheters "
              "of a temporary implant are always together",
              [](auto& s, const Slot&) { return &s.procedure.together; });
  keys.texts(
      "procedure.stabilising", 0,
      "template holes of needles without seeds, which go in first and stay to hold the gland; with a plan they go "
      "as deep as its deepest needle, in stylet insert each goes in as the first insertion would through its "
      "hole",
      [](auto& s, const Slot&) { return &s.procedure.stabilising; }, {.standard = "[]", .example = "[\"C3\", \"E3\"]"});
  keys.number("procedure.speed_mm_per_s", "mm/s", 0.1, 1000, "speed of a needle's base on the way in",
              [](auto& s, const Slot&) { return &s.procedure.speed_mm_per_s; });
  keys.number("procedure.pause_s", "s", 0, 3600,
              "pause at full depth before the first seed is dropped, and before each seed with technique = \"pushed\"; "
              "in a temporary implant, from the last catheter's full depth to the images of the plan",
              [](auto& s, const Slot&) { return &s.procedure.pause_s; });
  keys.number("procedure.drop_speed_mm_per_s", "mm/s", 0.1, 1000,
              "speed of a needle's base on its way out while seeds are dropped",
              [](auto& s, const Slot&) { return &s.procedure.drop_speed_mm_per_s; });
  keys.number("procedure.retract_speed_mm_per_s", "mm/s", 0.1, 1000,
              "speed of a needle's base on the rest of its way out",
              [](auto& s, const Slot&) { return &s.procedure.retract_speed_mm_per_s; });
  keys.number("procedure.plug_mm", "mm", 0, 30,
              "length of the plug, of bone wax for instance, between the needle's tip and the first seed",
              [](auto& s, const Slot&) { return &s.procedure.plug_mm; });
  keys.number("procedure.catheter_tip_mm", "mm", 0, 50,
              "temporary implants: distance from a catheter's tip to the centre of its most distal dwell position; the "
              "default is an assumption, since it depends on catheter and afterloader",
              [](auto& s, const Slot&) { return &s.procedure.catheter_tip_mm; });
  keys.number("procedure.planning_to_delivery_s", "s", 0, 86400,
              "temporary implants: time from the images on which the dwell times are planned, taken pause_s after the "
              "last catheter is in, to the delivery of the dose; the default, an hour, is an assumption",
              [](auto& s, const Slot&) { return &s.procedure.planning_to_delivery_s; });
  keys.boolean("seed.stranded",
               "whether the seeds of a needle are a strand, which keeps its spacing along its own, flexible line",
               [](auto& s, const Slot&) { return &s.seed.stranded; });
  keys.number(
      "seed.release_mm", "mm", -20, 20,
      "mean distance by which a seed jumps along its track when it is let go, positive towards the needle's tip; "
      "there is no published law",
      [](auto& s, const Slot&) { return &s.seed.release_mm; });
  keys.number("seed.release_sd_mm", "mm", 0, 20, "standard deviation of this distance",
              [](auto& s, const Slot&) { return &s.seed.release_sd_mm; });
  keys.number("seed.loss_percent", "%", 0, 100,
              "share of the seeds that are lost, to the lungs or with the urine; 0.5 to 1.1 % are published",
              [](auto& s, const Slot&) { return &s.seed.loss_percent; });
  keys.integer("seed.random", 0, 1000000000, "start of the random numbers for jumps and losses",
               [](auto& s, const Slot&) { return &s.seed.random; });
  keys.vector<3>(
      "oedema.swelling_percent", "%", 0, 200,
      "swelling of the gland after the implantation to the left, to posterior and to superior, as increase of "
      "its width; it carries seeds and tissue away from the gland's centre",
      [](auto& s, const Slot&) { return &s.oedema.swelling_percent; });
  keys.number("oedema.half_life_days", "d", 0.1, 1000,
              "half-life of the swelling; 9.3 d on average of 10 patients (Waterman et al. 1998)",
              [](auto& s, const Slot&) { return &s.oedema.half_life_days; });
}

void describe_insertion(ScenarioEntries& keys) {
  keys.text("insertion[].hole", "template hole; the needle then goes along +z (superior)",
            [](auto& s, const Slot& i) { return &plan(s, i).hole; }, {.example = "\"D4\""});
  keys.vector<3>("insertion[].entry_mm", "mm", -1e4, 1e4, "a point on the needle's line, LPS, instead of a hole",
                 [](auto& s, const Slot& i) { return &plan(s, i).entry_mm; }, {.example = "[10, 5, -80]"});
  keys.vector<3>("insertion[].direction", "", -1e4, 1e4, "direction of the insertion, LPS; a vector of any length",
                 [](auto& s, const Slot& i) { return &plan(s, i).direction; },
                 {.standard = "[0, 0, 1]", .example = "[0, 0, 1]"});
  keys.vector<3>("insertion[].target_mm", "mm", -1e4, 1e4, "a point to aim at, LPS, instead of a direction",
                 [](auto& s, const Slot& i) { return &plan(s, i).target_mm; }, {.example = "[10, 5, 0]"});
  keys.number("insertion[].roll_deg", "degree", -360, 360,
              "rotation of the needle about its axis; for a needle going superior, the bevel's sharp side is at the "
              "patient's left at 0 and posterior at 90",
              [](auto& s, const Slot& i) { return &plan(s, i).roll_deg; });
  keys.number("insertion[].approach_mm", "mm", 0.1, 200, "free travel before the skin",
              [](auto& s, const Slot& i) { return &plan(s, i).approach_mm; });
  keys.number("insertion[].depth_mm", "mm", 0, 1000,
              "travel of the base beyond skin contact; 0 = to the far end of the target",
              [](auto& s, const Slot& i) { return &plan(s, i).depth_mm; });
  keys.number("insertion[].speed_mm_per_s", "mm/s", 0.01, 1000, "speed of the base on the way in",
              [](auto& s, const Slot& i) { return &plan(s, i).speed_mm_per_s; });
  keys.number("insertion[].dwell_s", "s", 0, 3600, "pause at full depth",
              [](auto& s, const Slot& i) { return &plan(s, i).dwell_s; });
  keys.number("insertion[].retract_speed_mm_per_s", "mm/s", 0.01, 1000, "speed of the base on the way out",
              [](auto& s, const Slot& i) { return &plan(s, i).retract_speed_mm_per_s; });
  keys.boolean("insertion[].retract", "draw the needle out after the pause",
               [](auto& s, const Slot& i) { return &plan(s, i).retract; });
  keys.text("insertion[].motion",
            "CSV file of a recorded base motion (time_s, x_mm, y_mm, z_mm, qw, qx, qy, qz), which replaces all keys "
            "above; a relative path starts at the scenario file's folder",
            [](auto& s, const Slot& i) { return &plan(s, i).motion; }, {.example = "\"base_motion.csv\""});
}

void describe_run_and_output(ScenarioEntries& keys) {
  keys.number("run.dt_ms", "ms", 0.01, 20, "time step", [](auto& s, const Slot&) { return &s.run.dt_ms; });
  keys.number("output.frames_per_s", "1/s", 0, 1000,
              "frames per second of simulated time that are kept for pictures and ParaView; 0 = only those of events",
              [](auto& s, const Slot&) { return &s.output.frames_per_s; });
  keys.integer("output.max_frames", 2, 5000, "largest number of these frames",
               [](auto& s, const Slot&) { return &s.output.max_frames; });
  keys.boolean("output.pictures", "still pictures in the report",
               [](auto& s, const Slot&) { return &s.output.pictures; });
}

}  // namespace

const std::vector<ScenarioEntry>& scenario_table() {
  static const std::vector<ScenarioEntry> table = [] {
    ScenarioEntries keys;
    keys.text("name", "name of this run in the report", [](auto& s, const Slot&) { return &s.name; });
    describe_patient(keys);
    describe_tissue(keys);
    describe_echo(keys);
    describe_supports(keys);
    describe_anatomy(keys);
    describe_mesh(keys);
    describe_needle(keys);
    describe_coupling(keys);
    describe_template(keys);
    describe_insertion(keys);
    describe_implant(keys);
    describe_imaging(keys);
    describe_run_and_output(keys);
    return std::move(keys).take();
  }();
  return table;
}

}  // namespace stylet
