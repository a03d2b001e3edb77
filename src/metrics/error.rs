//! Errors of the metrics.

/// Reason for which two images cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricError {
    /// An argument has another number of pixels than the image.
    #[error("`{what}` has {found} pixels, the image {expected}")]
    Length {
        /// The argument's name.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The image's length.
        expected: usize,
    },
    /// The image does not have as many pixels as its width and height say.
    #[error("the image has {found} pixels, which is not {width}×{height}")]
    Size {
        /// Pixels per row, as given.
        width: u32,
        /// Rows, as given.
        height: u32,
        /// Number of pixels.
        found: usize,
    },
    /// The image is smaller than the window that slides over it.
    #[error("the image is {width}×{height} pixels; both must be {least} or more")]
    TooSmall {
        /// Pixels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// Least width and height.
        least: u32,
    },
    /// A pixel's origin does not exist.
    #[error("pixel {pixel} comes from pixel {origin} of the last frame, which has {count}")]
    Origin {
        /// The pixel's index.
        pixel: usize,
        /// The origin's index.
        origin: usize,
        /// Number of pixels of the last frame.
        count: usize,
    },
}

impl MetricError {
    /// Checks that an argument has as many pixels as the image.
    pub(super) fn length(what: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found == expected { Ok(()) } else { Err(Self::Length { what, found, expected }) }
    }

    /// Checks that an image has as many pixels as its size says.
    pub(super) fn size([width, height]: [u32; 2], found: usize) -> Result<(), Self> {
        let expected = u64::from(width) * u64::from(height);
        if found as u64 == expected { Ok(()) } else { Err(Self::Size { width, height, found }) }
    }

    /// Checks that every pixel comes from one that exists.
    pub(super) fn origins(origins: &[Option<usize>], count: usize) -> Result<(), Self> {
        let known = origins.iter().enumerate().filter_map(|(pixel, &origin)| Some((pixel, origin?)));
        match known.into_iter().find(|&(_, origin)| origin >= count) {
            Some((pixel, origin)) => Err(Self::Origin { pixel, origin, count }),
            None => Ok(()),
        }
    }
}
