//! Files of activecell.
