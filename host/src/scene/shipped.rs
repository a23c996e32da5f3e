//! The scenes that the program carries.

/// The paper's slide with its Table 2 as given, its ramp as printed.
pub const CD_ROM_SLIDE: &str = include_str!("../../scenes/cd-rom-slide.toml");

/// Names and texts of the shipped scenes.
pub const SHIPPED: &[(&str, &str)] = &[
    ("drawer", include_str!("../../scenes/drawer.toml")),
    ("cd-rom-slide", CD_ROM_SLIDE),
    ("cd-rom-slide-fast", include_str!("../../scenes/cd-rom-slide-fast.toml")),
    ("cd-rom-slide-drawing", include_str!("../../scenes/cd-rom-slide-drawing.toml")),
    ("three-part-stack", include_str!("../../scenes/three-part-stack.toml")),
    ("clutch", include_str!("../../scenes/clutch.toml")),
    ("clutch-processes", include_str!("../../scenes/clutch-processes.toml")),
    ("shaft-housing", include_str!("../../scenes/shaft-housing.toml")),
    ("slide-processes", include_str!("../../scenes/slide-processes.toml")),
    ("linear-chain", include_str!("../../scenes/linear-chain.toml")),
    ("three-locators", include_str!("../../scenes/three-locators.toml")),
    ("lid-on-pins", include_str!("../../scenes/lid-on-pins.toml")),
    ("worn-tool", include_str!("../../scenes/worn-tool.toml")),
    ("slider-crank", include_str!("../../scenes/slider-crank.toml")),
    ("slider-crank-guide", include_str!("../../scenes/slider-crank-guide.toml")),
    ("four-bar", include_str!("../../scenes/four-bar.toml")),
    ("woodpecker-toy", include_str!("../../scenes/woodpecker-toy.toml")),
    ("linear-guide", include_str!("../../scenes/linear-guide.toml")),
    ("telescopic-drawer", include_str!("../../scenes/telescopic-drawer.toml")),
    ("hatch", include_str!("../../scenes/hatch.toml")),
    ("ball-rod", include_str!("../../scenes/ball-rod.toml")),
];

/// The text of the shipped scene of this name.
pub fn shipped(name: &str) -> Option<&'static str> {
    SHIPPED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
