//! A bounding-volume tree over boxes.
