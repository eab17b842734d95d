// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

TEST(CanonicalRegion, usual_names_are_recognised_whatever_their_case_and_separators) {
  const std::vector<std::pair<std::string, std::string>> names{{"Prostate", "prostate"},
                                                               {"PROS", "prostate"},
                                                               {"prostate_gland", "prostate"},
                                                               {"Prostata", "prostate"},
                                                               {"PZ", "peripheral_zone"},
                                                               {"Peripheral Zone", "peripheral_zone"},
                                                               {"transition-zone", "transition_zone"},
                                                               {"CZ", "central_zone"},
                                                               {"AFS", "anterior_stroma"},
                                                               {"URETHRA", "urethra"},
                                                               {"Harnröhre", "urethra"},
                                                               {"Bladder", "bladder"},
                                                               {"Blase", "bladder"},
                                                               {"Rectum", "rectum"},
                                                               {"Rectal wall", "rectum"},
                                                               {"Pubic arch", "pubic_arch"},
                                                               {"pubis", "pubic_arch"},
                                                               {"Symphysis", "pubic_arch"},
                                                               {"BODY", "body"},
                                                               {"EXTERNAL", "body"},
                                                               {"Skin", "body"},
                                                               {"Seminal vesicles", "seminal_vesicles"},
                                                               {"Femoral Head Lt", "femur_left"},
                                                               {"Femoral Head RT", "femur_right"},
                                                               {"Femur_Head_L", "femur_left"},
                                                               {"R femur", "femur_right"},
                                                               {"PTV", "ptv"},
                                                               {"PTV_7800", "ptv"},
                                                               {"CTV 78 Gy", "ctv"},
                                                               {"GTV1", "gtv"},
                                                               {"Target", "target"},
                                                               {"Target volume 1", "target"}};
  for (const auto& [name, canonical] : names) EXPECT_EQ(canonical_region(name), canonical) << name;
}

TEST(CanonicalRegion, zones_are_recognised_as_people_write_them) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> names{
      {"peripheral_zone",
       {"peripheral", "PZ", "pz", "peripheral zone", "Peripheral_Zone", "PeripheralZone", "PZ_left", "L PZ", "PZ-R",
        "Prostate PZ", "prostatepz", "Left peripheral zone", "Peripheral zone of prostate", "peripheralzone_rt",
        "Structure of peripheral zone of prostate gland"}},
      {"transition_zone",
       {"transition", "Transition_Zone", "transitional", "TZ", "TZ_right", "transition zone of the prostate", "CG",
        "central gland", "TransitionZone"}},
      {"central_zone", {"central", "CZ", "Central zone", "central zone of prostate", "CZ_L"}},
      {"anterior_stroma",
       {"AFS", "afms", "anterior fibromuscular stroma", "Anterior_Fibromuscular_Stroma", "fibromuscular stroma",
        "Anterior fibromuscular stroma of prostate"}}};
  for (const auto& [canonical, written] : names) {
    for (const std::string& name : written) EXPECT_EQ(canonical_region(name), canonical) << name;
  }
  for (const std::string name :
       {"peripheral nerve", "central artery", "optPZ", "PZ lesion", "zone", "left", "of the"}) {
    EXPECT_EQ(canonical_region(name), "") << name;
  }
}

TEST(CanonicalRegion, a_canonical_name_is_its_own_synonym) {
  for (const std::string name : {"prostate", "peripheral_zone", "transition_zone", "central_zone", "anterior_stroma",
                                 "urethra", "bladder", "rectum", "pubic_arch", "femur_left", "femur_right", "band",
                                 "body", "seminal_vesicles", "ctv", "target", "ptv", "gtv"}) {
    EXPECT_EQ(canonical_region(name), name);
  }
}

TEST(CanonicalRegion, planning_helpers_and_channels_are_not_anatomy) {
  for (const std::string name :
       {"optBladder", "optRectum", "X1", "XApprox", "a5.5", "B4.5", "Prostate+5mm", "PTV-Rectum", "Vessels - left",
        "ring", "", "  ", "Rectum_in_PTV", "Femoral Head", "PTVboost"}) {
    EXPECT_EQ(canonical_region(name), "") << name;
  }
}

TEST(CanonicalRegion, organs_are_recognised_in_several_languages_whatever_their_accents_and_case) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> names{
      {"prostate",
       {"PROSTATA", "Vorsteherdrüse", "VORSTEHERDRÜSE", "próstata", "Pro\u0301stata", "PRÓSTATA", "Glande prostatique",
        "glándula prostática", "前列腺", "攝護腺", "前立腺", "ＰＲＯＳＴＡＴＥ", "Простата", "ПРОСТАТА",
        "Предстательная железа", "предстательной железы"}},
      {"urethra",
       {"HARNRÖHRE", "Harnroehre", "Urètre", "URETRE", "uretra prostática", "尿道", "前列腺尿道", "Уретра",
        "Мочеиспускательный канал"}},
      {"bladder",
       {"Harnblase", "Vessie", "Vejiga urinaria", "膀胱", "Мочевой пузырь", "МОЧЕВОЙ ПУЗЫРЬ", "моч. пузырь"}},
      {"rectum", {"Mastdarm", "Rektum", "Recto", "paroi rectale", "直肠", "直腸", "Прямая кишка", "прямой кишки"}},
      {"seminal_vesicles",
       {"Samenblase", "Samenbläschen", "Vésicules séminales", "vesicules_seminales", "Vesículas seminales", "精囊",
        "精嚢腺", "Семенные пузырьки", "семенной пузырёк"}},
      {"pubic_arch",
       {"Schambeinbogen", "Symphyse pubienne", "Sínfisis del pubis", "arco púbico", "耻骨联合", "恥骨結合",
        "Лобковый симфиз"}},
      {"body", {"Außenkontur", "KÖRPER", "Contour externe", "Contorno externo", "体表", "外轮廓", "Тело", "Кожа"}},
      {"femur_left",
       {"Hüftkopf links", "Femurkopf li", "Tête fémorale gauche", "TETE FEMORALE G", "cabeza femoral izquierda",
        "左股骨头", "股骨头（左）", "左大腿骨頭", "Головка левой бедренной кости", "Головка бедра лев."}},
      {"femur_right",
       {"Hüftkopf rechts", "Tête fémorale droite", "Cabeza femoral der", "右侧股骨头", "右大腿骨頭",
        "Правая головка бедренной кости"}},
      {"peripheral_zone",
       {"periphere Zone", "Zone périphérique", "zona periférica", "外周带", "左外周带", "前列腺外周带", "辺縁域",
        "Периферическая зона"}},
      {"transition_zone",
       {"Übergangszone", "zone de transition", "Zona de transición", "移行带", "移行域", "Переходная зона"}},
      {"central_zone", {"zentrale Zone", "zone centrale", "zona central", "中央带", "Центральная зона"}}};
  for (const auto& [canonical, written] : names) {
    for (const std::string& name : written) EXPECT_EQ(canonical_region(name), canonical) << name;
  }
}

TEST(CanonicalRegion, helpers_and_neighbours_are_not_organs_in_any_language) {
  for (const std::string name : {"Prostata-PTV",
                                 "Prostata+5mm",
                                 "optBlase",
                                 "Blase minus PTV",
                                 "Blasenhals",
                                 "Prostatabett",
                                 "Ring Prostata",
                                 "Urethra-Bulbus",
                                 "Rektum in PTV",
                                 "Haut-5mm",
                                 "Tête fémorale",
                                 "vessie - PTV",
                                 "corps étranger",
                                 "anneau rectum",
                                 "Rectosigmoide",
                                 "col vésical",
                                 "bulbe pénien",
                                 "recto anterior",
                                 "vejiga-PTV",
                                 "cuello vesical",
                                 "前列腺床",
                                 "前列腺PTV",
                                 "膀胱颈",
                                 "直肠外扩",
                                 "直腸-PTV",
                                 "精管",
                                 "Простата+5мм",
                                 "ПЖ",
                                 "прямая кишка минус PTV",
                                 "шейка пузыря",
                                 "головка полового члена",
                                 "SB",
                                 "Femoral head left + right"}) {
    EXPECT_EQ(canonical_region(name), "") << name;
  }
}

TEST(TargetRegion, gland_and_zones_and_planning_volumes_are_targets_and_organs_are_not) {
  for (const std::string name : {"prostate", "peripheral_zone", "transition_zone", "ctv", "target", "ptv", "gtv"}) {
    EXPECT_TRUE(is_target_region(name)) << name;
  }
  for (const std::string name : {"bladder", "urethra", "body", "band", ""})
    EXPECT_FALSE(is_target_region(name)) << name;
}

}  // namespace
}  // namespace stylet
