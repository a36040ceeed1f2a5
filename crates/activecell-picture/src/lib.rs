//! Pictures of activecell.
