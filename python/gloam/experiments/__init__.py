"""Parts that all experiments of Gloam share: results folders, requests, statistics, tables, charts, videos and pages."""
