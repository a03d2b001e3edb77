//! The bindings that hold a scene, each with the name that it has in WGSL.

/// A buffer or texture of the scene, as shaders/shared/scene.wgsl and its neighbours declare it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SceneBinding {
    Scene,
    Geometry,
    Attributes,
    Materials,
    Lights,
    Images,
    Environment,
    EnvironmentTable,
    Facets,
    FacetOwners,
    PlacementsBefore,
    CornersBefore,
    AnalyticLights,
    AnalyticLightsBefore,
}

impl SceneBinding {
    /// The binding of a variable in WGSL.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "scene" => Self::Scene,
            "geometry" => Self::Geometry,
            "attributes" => Self::Attributes,
            "materials" => Self::Materials,
            "lights" => Self::Lights,
            "images" => Self::Images,
            "environment" => Self::Environment,
            "environment_table" => Self::EnvironmentTable,
            "facets" => Self::Facets,
            "facet_owners" => Self::FacetOwners,
            "placements_previous" => Self::PlacementsBefore,
            "corners_previous" => Self::CornersBefore,
            "analytic_lights" => Self::AnalyticLights,
            "analytic_lights_previous" => Self::AnalyticLightsBefore,
            _ => return None,
        })
    }
}
