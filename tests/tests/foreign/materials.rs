//! BTFs and BRDFs, as folders and as files of others.
